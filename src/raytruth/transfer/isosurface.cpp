#include "raytruth/transfer/isosurface.hpp"

#include "raytruth/transfer/piecewise_linear.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

namespace raytruth {

void check(const std::vector<Isosurface>& isosurfaces) {
  for (std::size_t i = 0; i < isosurfaces.size(); ++i) {
    const Isosurface& surface = isosurfaces[i];
    if (!std::isfinite(surface.s))
      throw PointError(i, fmt::format("found s {}; a finite number is allowed", surface.s));
    if (i > 0 && !(isosurfaces[i - 1].s < surface.s))
      throw PointError(i, fmt::format("found s {} after {}; isosurfaces sorted by s, no two at one, are allowed",
                                      surface.s, isosurfaces[i - 1].s));
    if (!(surface.opacity >= 0 && surface.opacity <= 1))
      throw PointError(i, fmt::format("found opacity {}; a number from 0 to 1 is allowed", surface.opacity));
    if (!(surface.color >= 0).all() || !surface.color.isFinite().all())
      throw PointError(i, fmt::format("found color [{}, {}, {}]; finite numbers >= 0 are allowed", surface.color[0],
                                      surface.color[1], surface.color[2]));
  }
}

}  // namespace raytruth
