#pragma once

#include "raytruth/core/real50.hpp"
#include "raytruth/shading/normal_curve.hpp"

namespace raytruth {

/// What 50 digits make of the formula of a curve between normals.
struct NormalCurve50 {
  Real50 (*weight)(const Real50& s, const Real50& cosine);
};

/// N(s) of a curve.
inline PlaneVector<Real50> normal_at(const NormalCurve& curve, const Real50& s, const Real50& cosine) {
  return plane_vector<Real50>(curve.in_50_digits->weight(1 - s, cosine), curve.in_50_digits->weight(s, cosine), cosine);
}

}  // namespace raytruth
