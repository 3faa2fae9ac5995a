#pragma once

#include <algorithm>
#include <array>

namespace raytruth {

/// How far the ray that is meant may be from the one at hand, both parametrised by the length behind their own entries:
/// along each axis, t voxels behind the entry, by at most `at_entry` + t `per_voxel` voxels. The default: not at all.
struct RayDisplacement {
  std::array<double, 3> at_entry{};   ///< voxels
  std::array<double, 3> per_voxel{};  ///< voxels, for each that the ray has gone
  double of_length = 0;               ///< by how much its length inside of the field may differ, voxels
  bool may_differ_in_all = false;     ///< nothing is known: the one may enter the field and the other not

  /// The largest along any axis, up to `length` voxels behind the entry.
  [[nodiscard]] double largest(double length) const {
    double result = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) result = std::max(result, at_entry[axis] + length * per_voxel[axis]);
    return result;
  }
};

}  // namespace raytruth
