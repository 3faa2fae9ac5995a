#include "raytruth/transfer/isoslab.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace raytruth {

PiecewiseLinear isoslab_transfer(const std::vector<Isosurface>& surfaces, double width, double factor) {
  check(surfaces);
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Isosurface& surface = surfaces[i];
    if (!(surface.opacity < 1))
      throw PointError(i, "found opacity 1; below 1 is allowed in isoslabs, whose extinctions are finite");
    const double low = surface.s - width / 2;
    const double high = surface.s + width / 2;
    if (!points.empty() && !(points.back().s < low))
      throw PointError(i, fmt::format("found isoslabs of width {} around {} and {}, which touch; narrower ones are "
                                      "allowed",
                                      width, surfaces[i - 1].s, surface.s));
    const double extinction = -std::log1p(-surface.opacity) * factor / width;
    for (const auto& [s, tau] : {std::pair{low, 0.0}, {low, extinction}, {high, extinction}, {high, 0.0}})
      points.push_back({.s = s, .optics = {.extinction = tau, .color = surface.color}});
  }
  return PiecewiseLinear(std::move(points));
}

}  // namespace raytruth
