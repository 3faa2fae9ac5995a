#pragma once

#include "raytruth/signals/tricubic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace raytruth {

/// The clamped tricubic reconstruction at one point in voxel coordinates, straight from its 64 voxels: the sum of the
/// voxels times the kernel's values on each axis. What a renderer does at every sample; `trace_tricubic` is judged
/// against it in 50 digits.
template <class Real>
Real tricubic_value(const Grid& grid, CubicKernel kernel, const std::array<Real, 3>& point) {
  using std::floor;
  std::array<std::array<Real, 4>, 3> weight{};
  std::array<std::array<std::int64_t, 4>, 3> voxel{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real cell = floor(point[axis]);
    const Real u = point[axis] - cell;
    const Real v = Real(1) - u;
    const std::array<Real, 4> basis{v * v * v, Real(3) * u * v * v, Real(3) * u * u * v, u * u * u};
    for (std::size_t i = 0; i < 4; ++i) {
      weight[axis][i] = Real(0);
      for (std::size_t k = 0; k < 4; ++k)
        weight[axis][i] = weight[axis][i] + basis[k] * kernel_coefficient<Real>(kernel, k, i);
      voxel[axis][i] = std::clamp(static_cast<std::int64_t>(cell) - 1 + static_cast<std::int64_t>(i), std::int64_t{0},
                                  grid.size[axis] - 1);
    }
  }
  Real sum(0);
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        sum += weight[0][i] * weight[1][j] * weight[2][k] * Real(grid.at(voxel[0][i], voxel[1][j], voxel[2][k]));
  return sum;
}

}  // namespace raytruth
