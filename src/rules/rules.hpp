#pragma once

#include "core/bernstein.hpp"
#include "core/real.hpp"

#include <Eigen/Core>

namespace raytruth {

/// The local formulas, one text for every arithmetic: the characters of the .glsl files, which shaders include, are
/// compiled here with `real` as binary32, binary64 or 50 digits. What a formula means stands in its file.
///
/// The text keeps to what both languages share: `real`, `vec4`, literals that are exact in binary, no swizzles.
template <class Real>
struct Rules {
  using real = Real;
  using vec4 = Eigen::Array<Real, 4, 1>;

  // clang-format off
#include "rules/order0.glsl"
#include "rules/order1.glsl"
#include "rules/order2.glsl"
#include "rules/virtual_catmull_rom.glsl"
#include "rules/virtual_sample.glsl"
  // clang-format on

  static Bernstein<3, Real> cubic(const vec4& b) { return {{b[0], b[1], b[2], b[3]}}; }
};

}  // namespace raytruth
