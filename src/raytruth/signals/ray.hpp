#pragma once

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace raytruth {

/// A ray in voxel coordinates: origin + t direction, t >= 0, t in voxels once the direction is normalised.
struct Ray {
  std::array<double, 3> origin{};
  std::array<double, 3> direction{};
  double length = std::numeric_limits<double>::infinity();  ///< cuts the ray, counted from where it enters the grid
};

/// The rounded unit vector along `direction`; every result is exact for this vector.
/// Throws InputError for a direction that is zero or not finite.
inline std::array<double, 3> unit_direction(const std::array<double, 3>& direction) {
  const double norm = std::hypot(direction[0], direction[1], direction[2]);
  if (!std::isfinite(norm) || norm < std::numeric_limits<double>::min())
    throw InputError(fmt::format("direction [{}, {}, {}]; a finite vector that is not zero is allowed", direction[0],
                                 direction[1], direction[2]));
  // A component this small moves no ray by a representable amount; as zero, it cannot overflow a reciprocal.
  const auto component = [norm](double x) { return std::abs(x / norm) < 0x1p-500 ? 0.0 : x / norm; };
  return {component(direction[0]), component(direction[1]), component(direction[2])};
}

}  // namespace raytruth
