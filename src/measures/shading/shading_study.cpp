#include "measures/shading/shading_study.hpp"

#include "raytruth/shading/slab_shading.hpp"

#include <cmath>
#include <numbers>

namespace raytruth {

Vector3<double> studied_direction(double in_plane, double tilt) {
  const double angle = in_plane * std::numbers::pi / 180;
  const double out = tilt * std::numbers::pi / 180;
  return {std::sin(angle) * std::cos(out), std::sin(out), std::cos(angle) * std::cos(out)};
}

ShadedSlab studied_slab(double angle) {
  ShadedSlab slab;
  slab.front_normal = studied_direction(-angle / 2);
  slab.back_normal = studied_direction(angle / 2);
  return slab;
}

std::vector<const Shading*> studied_shadings() {
  std::vector<const Shading*> list;
  for (const Shading& shading : catalogue::shadings())
    if (!shading.needs_extinction && shading.name != "normalized_linear") list.push_back(&shading);
  return list;
}

}  // namespace raytruth
