#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/real.hpp"

#include <Eigen/Core>

#include <cmath>

namespace raytruth {

/// The local formulas, one text for every arithmetic: the characters of the .glsl files, which shaders include, are
/// compiled here with `real` as binary32, binary64 or 50 digits. What a formula means stands in its file.
///
/// The text keeps to what both languages share: `real`, `vec4`, literals that are exact in binary, no swizzles, and the
/// functions below.
template <class Real>
struct Rules {
  using real = Real;
  using vec4 = Eigen::Array<Real, 4, 1>;

  // Members, so that literals convert to `real` in them.
  static real min(const real& a, const real& b) { return b < a ? b : a; }
  static real max(const real& a, const real& b) { return a < b ? b : a; }
  static real floor(const real& x) {
    using std::floor;
    return floor(x);
  }
  static real sqrt(const real& x) {
    using std::sqrt;
    return sqrt(x);
  }
  static real expm1(const real& x) {
    using std::expm1;
    return expm1(x);
  }
  static real log1p(const real& x) {
    using std::log1p;
    return log1p(x);
  }
  static real power(const real& x, const real& y) {
    using std::pow;
    return pow(x, y);
  }
  static real arc_cosine(const real& x) {
    using std::acos;
    return acos(x);
  }
  static real sine(const real& x) {
    using std::sin;
    return sin(x);
  }

  // clang-format off
#include "raytruth/rules/order0.glsl"
#include "raytruth/rules/order1.glsl"
#include "raytruth/rules/order2.glsl"
#include "raytruth/rules/order3.glsl"
#include "raytruth/rules/quadratic_gray.glsl"
#include "raytruth/rules/virtual_catmull_rom.glsl"
#include "raytruth/rules/virtual_sample.glsl"
#include "raytruth/rules/cubic_split.glsl"
#include "raytruth/rules/absorption.glsl"
#include "raytruth/rules/over.glsl"
#include "raytruth/rules/homogeneous.glsl"
#include "raytruth/rules/trapezoid.glsl"
#include "raytruth/rules/simpson.glsl"
#include "raytruth/rules/opacity_correction.glsl"
#include "raytruth/rules/texture_filter.glsl"
#include "raytruth/rules/table_look_up.glsl"
#include "raytruth/rules/normal_curves.glsl"
#include "raytruth/rules/highlights.glsl"
#include "raytruth/rules/lighting.glsl"
#include "raytruth/rules/fades.glsl"
#include "raytruth/rules/gooch.glsl"
#include "raytruth/rules/isosurface.glsl"
  // clang-format on

  static Bernstein<3, Real> cubic(const vec4& b) { return {{b[0], b[1], b[2], b[3]}}; }
};

}  // namespace raytruth
