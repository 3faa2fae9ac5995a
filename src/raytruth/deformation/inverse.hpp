#pragma once

#include "raytruth/deformation/lattice.hpp"

#include <Eigen/Core>

namespace raytruth {

// Which point of the object a point of the world shows: Q with F(Q) = P. With the displacement u(Q) = F(Q) - Q,
// Q = P - u(P) + Du(P) u(P) + ...

/// 2 P - F(P), right to first order in the displacement (dissertation, 7.5.1).
Eigen::Vector3d printed_inverse(const Lattice& lattice, const Eigen::Vector3d& world);

/// Q <- P - u(Q), some times, from Q = P; once is the printed inverse. Each step divides the error by 1 / |Du|.
Eigen::Vector3d fixed_point_inverse(const Lattice& lattice, const Eigen::Vector3d& world, int steps);

/// A point of the object with a bound of how far it is from the one that the world's point shows.
struct CertifiedInverse {
  Eigen::Vector3d object = Eigen::Vector3d::Zero();
  double radius = 0;    ///< infinite: Newton's steps led nowhere
  int evaluations = 0;  ///< of F with DF
};

/// Newton's steps to rounding from a point of the object. With the residual r = |F(Q) - P|, w = 1 / |DF(Q)^-1| and
/// second derivatives of at most K (Kantorovich's theorem) there is one root within 2 r / w where 2 r K <= w^2. F being
/// one to one (`proof_of`), it is the root.
CertifiedInverse newton_inverse(const Lattice& lattice, const Eigen::Vector3d& world, const Eigen::Vector3d& start);

}  // namespace raytruth
