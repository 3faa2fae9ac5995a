#pragma once

#include "raytruth/core/vector3.hpp"

#include <Eigen/Core>

namespace raytruth {

/// What a part of a ray does, seen from its front: the light that it sends there, and how much it absorbs of what lies
/// behind it. Opacity, not transmittance, so that faint matter keeps its digits. Slabs are put together by
/// rules/over.glsl, which takes them as four numbers.
template <class Real = double>
struct Slab {
  Vector3<Real> color = Vector3<Real>::Constant(Real(0));
  Real opacity = Real(0);

  /// Colour and opacity as the four numbers of a pixel, a texel or a rule.
  [[nodiscard]] Eigen::Array<Real, 4, 1> rgba() const { return {color[0], color[1], color[2], opacity}; }
};

}  // namespace raytruth
