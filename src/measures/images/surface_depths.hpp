#pragma once

#include "raytruth/render/scene.hpp"

#include <vector>

namespace raytruth {

/// How far behind the entry of every pixel's ray, in smallest spacings, half of the light is absorbed, pixel by pixel;
/// not a number where less is in all. The scene's own reconstruction is followed in steps of a 64th of the smallest
/// spacing, where the optical depth goes by the trapezoid rule and linearly in between: of a surface at a jump of the
/// transfer function the depth is exact to about that.
std::vector<double> surface_depths(const Scene& scene);

}  // namespace raytruth
