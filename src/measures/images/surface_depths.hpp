#pragma once

#include "raytruth/render/scene.hpp"

#include <vector>

namespace raytruth {

/// How far behind the entry of every pixel's ray, in smallest spacings, half of the light is absorbed, pixel by pixel;
/// not a number where less is in all. The scene's own reconstruction is followed by the trapezoid rule in steps of a
/// 64th of the smallest spacing, which are halved where the extinction changes much: at jumps of the transfer function
/// down to 2^-20.
std::vector<double> surface_depths(const Scene& scene);

}  // namespace raytruth
