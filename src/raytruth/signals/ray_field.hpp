#pragma once

#include "raytruth/signals/border.hpp"
#include "raytruth/signals/field_kind.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/signals/tricubic.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <optional>
#include <variant>
#include <vector>

namespace raytruth {

// A field is a thing that traces: it makes chains of polynomials of the rays through it, and says how far they may be
// from the scalar, up to where it ends. Each refers to the voxels that it is made of, which must outlive it. Lengths
// are in voxels.

/// Trilinear interpolation: a cubic in every cell.
class TrilinearField {
 public:
  static constexpr int degree = 3;

  explicit TrilinearField(const Grid& voxels, Border border = Border::half_voxel) : voxels_(&voxels), border_(border) {}

  [[nodiscard]] FieldKind kind() const { return FieldKind::trilinear; }
  [[nodiscard]] Border border() const { return border_; }
  /// What is interpolated.
  [[nodiscard]] const Grid& grid() const { return *voxels_; }

  void trace(const Ray& ray, Chain<3>& chain) const { trace_trilinear(*voxels_, ray, chain, border_); }
  /// `is_needless` and `displacement` as in `trilinear_error`.
  [[nodiscard]] SignalError error(const Ray& ray, const Chain<3>& chain, const std::vector<bool>& is_needless = {},
                                  const RayDisplacement& displacement = {}) const {
    return trilinear_error(*voxels_, ray, chain, is_needless, displacement, border_);
  }
  [[nodiscard]] PreciseChain<3> trace_precisely(const Ray& ray, const RayDisplacement& displacement = {}) const {
    return trace_trilinear_precisely(*voxels_, ray, displacement, border_);
  }

 private:
  const Grid* voxels_;
  Border border_;
};

/// Cubic reconstruction on every axis: degree 9 in every cell.
class TricubicField {
 public:
  static constexpr int degree = 9;

  /// `bspline`, `bspline_prefiltered`, whose coefficients it makes and keeps, or `catmull_rom`.
  TricubicField(const Grid& voxels, FieldKind kind, Border border = Border::half_voxel)
      : voxels_(&voxels), kind_(kind), border_(border) {
    if (kind != FieldKind::bspline_prefiltered) return;
    coefficients_ = bspline_coefficients(voxels);
    coefficient_error_ = prefilter_error(voxels, *coefficients_);
  }

  [[nodiscard]] FieldKind kind() const { return kind_; }
  [[nodiscard]] Border border() const { return border_; }
  /// What the kernel weighs: the voxels, or coefficients that interpolate them.
  [[nodiscard]] const Grid& grid() const { return coefficients_ ? *coefficients_ : *voxels_; }

  void trace(const Ray& ray, Chain<9>& chain) const { trace_tricubic(grid(), kernel(), ray, chain, border_); }
  [[nodiscard]] SignalError error(const Ray& ray, const Chain<9>& chain, const std::vector<bool>& is_needless = {},
                                  const RayDisplacement& displacement = {}) const {
    return tricubic_error(grid(), kernel(), ray, chain, coefficient_error_, is_needless, displacement, border_);
  }
  [[nodiscard]] PreciseChain<9> trace_precisely(const Ray& ray, const RayDisplacement& displacement = {}) const {
    return trace_tricubic_precisely(grid(), kernel(), ray, coefficient_error_, displacement, border_);
  }

 private:
  [[nodiscard]] CubicKernel kernel() const {
    return kind_ == FieldKind::catmull_rom ? CubicKernel::catmull_rom : CubicKernel::bspline;
  }

  const Grid* voxels_;
  FieldKind kind_;
  Border border_;
  std::optional<Grid> coefficients_;
  double coefficient_error_ = 0;
};

/// A field of any kind; std::visit gives it with its degree.
using RayField = std::variant<TrilinearField, TricubicField>;

inline RayField ray_field(const Grid& voxels, FieldKind kind, Border border) {
  if (kind == FieldKind::trilinear) return TrilinearField(voxels, border);
  return TricubicField(voxels, kind, border);
}

/// The chain in other units of length: 1 becomes `factor`.
template <int Degree>
void scale_lengths(Chain<Degree>& chain, double factor) {
  if (factor == 1) return;
  for (auto& piece : chain.pieces) {
    piece.start = piece.start * factor;
    piece.length *= factor;
  }
  chain.end = chain.end * factor;
}

}  // namespace raytruth
