#pragma once

#include "raytruth/volume/grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace raytruth {

/// The clamped trilinear reconstruction at one point in voxel coordinates, straight from its eight voxels:
///     sum over the corners of (1 - x or x)(1 - y or y)(1 - z or z) v.
/// What a renderer does at every sample; `trace_trilinear` is judged against it in 50 digits.
template <class Real>
Real trilinear_value(const Grid& grid, const std::array<Real, 3>& point) {
  using std::floor;
  std::array<std::array<Real, 2>, 3> weight{};
  std::array<std::array<std::int64_t, 2>, 3> voxel{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real cell = floor(point[axis]);
    weight[axis][1] = point[axis] - cell;
    weight[axis][0] = Real(1) - weight[axis][1];
    const std::int64_t last = grid.size[axis] - 1;
    const auto index = static_cast<std::int64_t>(cell);
    voxel[axis] = {std::clamp(index, std::int64_t{0}, last), std::clamp(index + 1, std::int64_t{0}, last)};
  }
  Real sum(0);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t i = 0; i < 2; ++i)
        sum += weight[0][i] * weight[1][j] * weight[2][k] * Real(grid.at(voxel[0][i], voxel[1][j], voxel[2][k]));
  return sum;
}

}  // namespace raytruth
