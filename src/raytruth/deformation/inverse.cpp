#include "raytruth/deformation/inverse.hpp"

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace raytruth {

Eigen::Vector3d printed_inverse(const Lattice& lattice, const Eigen::Vector3d& world) {
  return 2 * world - lattice(world);
}

Eigen::Vector3d fixed_point_inverse(const Lattice& lattice, const Eigen::Vector3d& world, int steps) {
  Eigen::Vector3d object = world;
  for (int i = 0; i < steps; ++i) object = world - (lattice(object) - object);
  return object;
}

CertifiedInverse newton_inverse(const Lattice& lattice, const Eigen::Vector3d& world, const Eigen::Vector3d& start) {
  CertifiedInverse result{.object = start, .radius = std::numeric_limits<double>::infinity(), .evaluations = 0};
  constexpr int most_steps = 40;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_steps; ++i) {
    const Eigen::Vector3d residual = lattice(result.object) - world;
    const Eigen::Matrix3d jacobian = lattice.jacobian(result.object);
    ++result.evaluations;
    const double size = residual.norm();
    if (!std::isfinite(size)) return result;
    if (size >= before / 2 && i > 0) {
      // No step helps any more: what is left is rounding, if the root is near.
      const double rounding = 0x1p-48 * (world.norm() + result.object.norm());
      const double r = size + rounding;
      const double w = 1 / jacobian.inverse().norm();
      if (w > 0 && 2 * r * lattice.bend() <= w * w) result.radius = 2 * r / w;
      return result;
    }
    before = size;
    result.object -= jacobian.partialPivLu().solve(residual);
  }
  return result;
}

}  // namespace raytruth
