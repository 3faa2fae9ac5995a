#pragma once

#include <array>
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
std::array<double, 3> unit_direction(const std::array<double, 3>& direction);

}  // namespace raytruth
