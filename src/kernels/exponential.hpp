#pragma once

#include "kernels/lanes.hpp"

#include <array>
#include <cstddef>

namespace raytruth::inline RAYTRUTH_LEVEL {

/// Half the distance from 1 to the next binary64 number: the relative error of one operation.
inline constexpr double unit_roundoff = 0x1p-53;

/// g_0 ... g_9 of e^r = 1 + (r + r^2 g(r)) for |r| <= 0.3466: Remez's exchange for the error relative to e^r, which
/// with these coefficients, rounded, is at most 0.1 units of 2^-53 (a test computes it).
inline constexpr std::array<double, 10> exponential_coefficients{
    0x1.000000000000ap-1,  0x1.55555555554fap-3,  0x1.5555555550880p-5,  0x1.1111111127bd4p-7,  0x1.6c16c18429335p-10,
    0x1.a01a012a5c042p-13, 0x1.a0199a0ee7035p-16, 0x1.71df254c77156p-19, 0x1.28ad706015ad7p-22, 0x1.ad7f71e4d6022p-26};

/// |exponential(y) - e^y| <= exponential_error e^y for -700 <= y <= 700.
///
/// Proof, in units of 2^-53. With n the integer next to y log2(e), r = y - n ln 2 and |r| <= 0.3466: ln 2 = high + low,
/// n high is exact, the two subtractions err by 0.3466 each, so r errs by 0.7, and e^r by as much of itself. The
/// polynomial leaves out 0.1. g errs by 4 of itself (sums of terms that shrink by 3 and more), r^2 g by 6, at most
/// 0.41; r + r^2 g then by 0.41 + 0.42 for r > 0, 0.33 + 0.3 for r < 0, and the last sum by 1 of itself. Relative to
/// e^r, at least 0.707 for r < 0: 1.9 together. The sum, 0.7 + 0.1 + 1.9, is below 3; 2^n is exact.
inline constexpr double exponential_error = 3 * unit_roundoff;

/// e^y for every lane (or for one number); y below -700 counts as -700. No table and no branch; Estrin's scheme, since
/// the latency of Horner's would be most of the time.
template <class Vector>
Vector exponential(const Vector& y) {
  constexpr double log2_e = 0x1.71547652b82fep0;
  constexpr double ln2_high = 0x1.62e42feep-1;  // 32 bits: its product with n is exact
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  constexpr double round_to_integer = 0x1.8p52;  // adding it leaves the integer in the low bits
  const auto clamped = larger<Vector>(-700, y);
  const Vector shifted = multiply_add(clamped, Vector(log2_e), Vector(round_to_integer));
  const Vector n = shifted - round_to_integer;
  const Vector r = multiply_add(n, Vector(-ln2_low), multiply_add(n, Vector(-ln2_high), clamped));
  const Vector r2 = r * r;
  const Vector r4 = r2 * r2;
  const auto two_terms = [&](std::size_t k) {
    return multiply_add(r, Vector(exponential_coefficients[k + 1]), Vector(exponential_coefficients[k]));
  };
  const auto four_terms = [&](std::size_t k) { return multiply_add(r2, two_terms(k + 2), two_terms(k)); };
  const Vector g = multiply_add(r4, multiply_add(r4, two_terms(8), four_terms(4)), four_terms(0));
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

/// A number not below 2^y (but for rounding, 2^-39 of it) and at most 1.07 times that, for y < 1024; y below -1000
/// counts as -1000. The chord of the power between two integers.
template <class Vector>
Vector power_of_2_above(const Vector& y) {
  return from_bits(to_bits((larger<Vector>(-1000, y) + 1023.0) * 0x1p40 + 0x1p52) << 12);
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
