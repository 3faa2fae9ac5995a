#pragma once

#include "raytruth/core/vector3.hpp"

#include <vector>

namespace raytruth {

/// A surface at one scalar, met wherever the scalar crosses it, upwards or downwards. What comes from behind it, T, is
/// followed by T opacity color of its own, whatever the emission, and becomes T (1 - opacity).
struct Isosurface {
  double s = 0;
  double opacity = 1;  ///< of one crossing, 0 to 1: it has neither a length nor an angle
  Vector3<double> color = Vector3<double>::Constant(1);  ///< >= 0, linear light, not multiplied by the opacity
};

/// Throws PointError unless all numbers are finite, scalars ascend strictly, opacities are in [0, 1] and no colour is
/// negative.
void check(const std::vector<Isosurface>& isosurfaces);

}  // namespace raytruth
