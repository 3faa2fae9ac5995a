#pragma once

#include "kernels/lanes.hpp"

namespace raytruth::inline RAYTRUTH_LEVEL {

/// Half the distance from 1 to the next binary64 number: the relative error of one operation.
inline constexpr double unit_roundoff = 0x1p-53;

/// |exponential(y) - e^y| <= exponential_error e^y for -700 <= y <= 700.
///
/// Proof, in units of 2^-53. With n the integer next to y log2(e), r = y - n ln 2 and |r| <= 0.3466: ln 2 = high + low,
/// n high is exact, the two subtractions err by 0.3466 each, so r errs by 0.7, and e^r by as much of itself. Taylor's
/// polynomial 1 + (r + r^2 g) of degree 13 leaves out 0.3466^14 / 14! = 0.04. g errs by 4 of itself (sums of terms that
/// shrink by 3 and more), r^2 g by 6, at most 0.41; r + r^2 g then by 0.41 + 0.42 for r > 0, 0.33 + 0.3 for r < 0, and
/// the last sum by 1 of itself. Relative to e^r, at least 0.707 for r < 0: 1.9 together. The sum, 0.7 + 0.04 + 1.9, is
/// below 3; 2^n is exact.
inline constexpr double exponential_error = 3 * unit_roundoff;

/// e^y for every lane (or for one number); y below -700 counts as -700. No table and no branch; Estrin's scheme, since
/// the latency of Horner's would be most of the time.
template <class Vector>
Vector exponential(const Vector& y) {
  constexpr double log2_e = 0x1.71547652b82fep0;
  constexpr double ln2_high = 0x1.62e42feep-1;  // 32 bits: its product with n is exact
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  constexpr double round_to_integer = 0x1.8p52;  // adding it leaves the integer in the low bits
  const Vector clamped = larger<Vector>(-700, y);
  const Vector shifted = multiply_add(clamped, Vector(log2_e), Vector(round_to_integer));
  const Vector n = shifted - round_to_integer;
  const Vector r = multiply_add(n, Vector(-ln2_low), multiply_add(n, Vector(-ln2_high), clamped));
  const Vector r2 = r * r;
  const Vector r4 = r2 * r2;
  const auto four_terms = [&](double g0, double g1, double g2, double g3) {
    return multiply_add(r2, multiply_add(r, Vector(g3), Vector(g2)), multiply_add(r, Vector(g1), Vector(g0)));
  };
  const Vector g_high = four_terms(1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800);
  const Vector g_middle = four_terms(1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880);
  const Vector g =
      multiply_add(r4, multiply_add(r4, g_high, g_middle), four_terms(1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120));
  const Vector e_to_r = 1.0 + multiply_add(r2, g, r);
  return from_bits(to_bits(e_to_r) + (to_bits(shifted) << 52));
}

/// A number not below log2(x) and at most 0.09 above, for normal x > 0: the exponent, and the chord of the logarithm
/// between two powers of two, which lies at most 0.0861 below it.
template <class Vector>
Vector log2_above(const Vector& x) {
  constexpr std::int64_t two_to_52 = 0x4330000000000000;
  return ((from_bits((to_bits(x) >> 12) | two_to_52) - 0x1p52) * 0x1p-40 - 1023.0) + 0.0862;
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
