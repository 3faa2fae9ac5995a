#pragma once

#include "raytruth/core/vector3.hpp"

namespace raytruth {

/// tau(s) = extinction exp(-(s - mean)^2 / (2 deviation^2)), c(s) = color + s color_slope.
struct GaussianTransfer {
  double mean = 0;
  double deviation = 1;   ///< above 0
  double extinction = 0;  ///< the largest, per unit length
  Vector3<double> color = Vector3<double>::Constant(0);
  Vector3<double> color_slope = Vector3<double>::Constant(0);
};

}  // namespace raytruth
