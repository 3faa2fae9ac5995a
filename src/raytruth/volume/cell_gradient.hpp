#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/vector3.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>

namespace raytruth {

/// Central differences at the eight voxels of a cell, per unit of `spacing`, trilinearly interpolated. Cell i of an
/// axis lies between voxels i and i + 1; in the clamped halves, -1 and n - 1, the gradient is that of the border.
class CellGradient {
 public:
  CellGradient(const Grid& grid, const std::array<std::int64_t, 3>& cell);

  /// The gradient at a place in [0, 1]^3.
  [[nodiscard]] Vector3<double> at(const std::array<double, 3>& place) const;

  /// The gradient along the segment from p to q in [0, 1]^3, axis by axis: cubics (signals/trilinear.hpp).
  [[nodiscard]] std::array<Bernstein<3>, 3> along(const std::array<double, 3>& p, const std::array<double, 3>& q) const;

 private:
  std::array<Vector3<double>, 8> corners_;  ///< x fastest
};

}  // namespace raytruth
