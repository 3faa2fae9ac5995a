#pragma once

#include "raytruth/reference/surface_hits.hpp"

#include <algorithm>
#include <array>

namespace raytruth {

/// Bounds how fast the scalar of a field of signals/ray_field.hpp can vary along any ray, per voxel. Along an axis that
/// is at most the largest difference of what the kernel weighs, times 1 for trilinear interpolation and for B-splines,
/// whose derivatives are means of neighbours' differences, and times 3/2 (5/4)^2 for Catmull-Rom splines, whose weights
/// may be negative; along a ray at most sqrt 3 times as much.
template <class Field>
double steepest_slope(const Field& field) {
  constexpr double most = 4.1;
  const auto [low, high] = field.grid().range();
  return most * (high - low);
}

/// What is known of a ray through a field, whose place is exactly the one stated.
template <class Field>
Surroundings surroundings_of(const Field& field, const std::array<double, 3>& direction) {
  return {.steepest = steepest_slope(field), .are_in_line = std::count(direction.begin(), direction.end(), 0.0) == 2};
}

}  // namespace raytruth
