#pragma once

#include "raytruth/core/double_double.hpp"
#include "raytruth/deformation/lattice.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>

namespace raytruth {

/// A function of a cell's local coordinates in powers, as LatticeCell has F.
using CellFunction = std::array<double, 27>;

/// The two equations of a ray o + t d in the world, e_1 . (P - o) = 0 and e_2 . (P - o) = 0. With p the axis of d's
/// largest component and a, b those that follow it, e_1 = d_p a - d_a p and e_2 = +-(d_p b - d_b p): both are exactly
/// at right angles to d, and e_1 x e_2 = +-|d_p| d. So the object's points on a deformed ray solve f_1 = f_2 = 0 with
/// f_i = e_i . (F - o); along their curve
///
///     dx/dr = grad f_1 x grad f_2,   dt/dr = +-|d_p| det(dF/dx),
///
/// and the length weighted by 1 / J, which is what light along a deformed ray sees, is r times a constant.
class RayEquations {
 public:
  /// `is_left_handed`: whether det(dF/dx) is negative, so that t rises with r for e_1 x e_2 = -|d_p| d.
  RayEquations(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, bool is_left_handed)
      : origin_(origin), direction_(direction) {
    direction.cwiseAbs().maxCoeff(&pivot_);
    const double sign = (direction[pivot_] < 0) == is_left_handed ? 1 : -1;
    along_other_ = {direction[pivot_], sign * direction[pivot_]};
    along_pivot_ = {-direction[other_axis(0)], -sign * direction[other_axis(1)]};
    for (std::size_t i = 0; i < 2; ++i)
      offset_[i] = two_product(along_other_[i], origin[other_axis(i)]) + two_product(along_pivot_[i], origin[pivot_]);
  }

  /// e_i . P
  [[nodiscard]] double along(std::size_t i, const Eigen::Vector3d& point) const {
    return along_other_[i] * point[other_axis(i)] + along_pivot_[i] * point[pivot_];
  }
  /// e_i . (P - o), rounded once.
  [[nodiscard]] double value(std::size_t i, const Eigen::Vector3d& point) const {
    return static_cast<double>(two_product(along_other_[i], point[other_axis(i)]) +
                               two_product(along_pivot_[i], point[pivot_]) - offset_[i]);
  }
  /// f_i in a cell.
  [[nodiscard]] CellFunction in_cell(std::size_t i, const LatticeCell& cell) const {
    CellFunction function{};
    for (std::size_t k = 0; k < function.size(); ++k) function[k] = along(i, cell.powers[k]);
    function[0] += value(i, cell.centre);
    return function;
  }

  /// t of a point on the ray.
  [[nodiscard]] double t_of(const Eigen::Vector3d& point) const {
    return direction_.dot(point - origin_) / direction_.squaredNorm();
  }

  /// |d_p|.
  [[nodiscard]] double scale() const { return std::abs(direction_[pivot_]); }

 private:
  [[nodiscard]] Eigen::Index other_axis(std::size_t i) const { return (pivot_ + 1 + static_cast<Eigen::Index>(i)) % 3; }
  Eigen::Vector3d origin_;
  Eigen::Vector3d direction_;
  Eigen::Index pivot_ = 0;
  std::array<double, 2> along_other_{};
  std::array<double, 2> along_pivot_{};
  std::array<DoubleDouble, 2> offset_{};
};

}  // namespace raytruth
