#pragma once

#include "raytruth/kernels/level.hpp"

#include <array>

namespace raytruth {

/// A stretch of a ray on which opacity and colour are linear in the normalised scalar x(u), 0 <= u <= 1, a polynomial
/// in Bernstein form: the opacity a of a unit of length, and so its rest 1 - a, are polynomials too. Both are held, for
/// near 0 the one, and near 1 the other has the digits. `Vector` is double; or Eight: eight pieces.
template <int Degree, class Vector = double>
struct OpacityPiece {
  std::array<Vector, Degree + 1> x{};
  std::array<Vector, Degree + 1> opacity{};  ///< a, each coefficient to 4 units of |a_0| |1 - x| + |a_1| |x|
  std::array<Vector, Degree + 1> clear{};    ///< 1 - a, likewise
  Vector x_error{};                          ///< bound on |x(u)| missed, at every u
  Vector clear_error{};                      ///< bound on |a(u)| missed by that
  Vector length{};                           ///< with a relative error of up to 2 units in the last place
  Vector units{};                            ///< of length: the extinction is -ln(1 - a) units / length; 4 units
};

}  // namespace raytruth
