#pragma once

#include "raytruth/reference/certified.hpp"

#include <Eigen/Core>

namespace raytruth {

/// What a pixel gets to see.
struct PixelLight {
  Eigen::Array4d light = Eigen::Array4d::Zero();  ///< light in the first three numbers, opacity in the fourth
  double radius = 0;                              ///< of references only
  Status status = Status::converged;
  bool has_unresolved_contact = false;  ///< with an isosurface
};

}  // namespace raytruth
