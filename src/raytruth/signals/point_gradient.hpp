#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/signals/field_kind.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <string_view>

namespace raytruth {

/// Where a point's gradient comes from.
enum class GradientKind {
  voxels,       ///< central differences at the voxels, trilinearly interpolated
  differences,  ///< central differences of the reconstruction, a voxel to both sides of the point (Lee 2010,
                ///< section 3.1)
  analytic,     ///< the derivative of the reconstruction; at a border of trilinear cells that of the cell behind it
};

inline constexpr std::array<std::string_view, 3> gradient_kind_names{"voxels", "differences", "analytic"};

/// The gradient of a reconstruction at any point, per unit of `spacing`. Through a trilinear field, away from the
/// grid's border, `voxels` and `differences` are the same but for rounding.
///
/// Refers to the grids, which must outlive it.
class PointGradient {
 public:
  /// A gradient of kind `voxels`.
  explicit PointGradient(const Grid& voxels)
      : PointGradient(voxels, voxels, FieldKind::trilinear, GradientKind::voxels) {}

  /// `reconstructed`: what the field's kernel weighs, the voxels or their coefficients (RayField).
  PointGradient(const Grid& voxels, const Grid& reconstructed, FieldKind field, GradientKind kind)
      : voxels_(&voxels), reconstructed_(&reconstructed), field_(field), kind_(kind) {}

  [[nodiscard]] const Grid& voxels() const { return *voxels_; }

  /// At a position in voxel coordinates.
  [[nodiscard]] Vector3<double> operator()(const std::array<double, 3>& position) const;

 private:
  const Grid* voxels_;
  const Grid* reconstructed_;
  FieldKind field_;
  GradientKind kind_;
};

/// The cell of a position in voxel coordinates, -1 and n - 1 being the clamped halves.
std::array<std::int64_t, 3> cell_of(const Grid& grid, const std::array<double, 3>& position);

/// The position in that cell's own coordinates, 0 to 1.
std::array<double, 3> in_cell(const std::array<double, 3>& position, const std::array<std::int64_t, 3>& cell);

}  // namespace raytruth
