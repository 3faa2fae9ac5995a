#pragma once

#include "raytruth/kernels/lanes.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace raytruth::inline RAYTRUTH_LEVEL {

/// Half the distance from 1 to the next binary64 number: the relative error of one operation.
inline constexpr double unit_roundoff = 0x1p-53;

/// g_0 ... g_9 of e^r = 1 + (r + r^2 g(r)) for |r| <= 0.3466: Remez's exchange for the error relative to e^r, which
/// with these coefficients, rounded, is at most 0.1 units of 2^-53 (a test computes it).
inline constexpr std::array<double, 10> exponential_coefficients{
    0x1.000000000000ap-1,  0x1.55555555554fap-3,  0x1.5555555550880p-5,  0x1.1111111127bd4p-7,  0x1.6c16c18429335p-10,
    0x1.a01a012a5c042p-13, 0x1.a0199a0ee7035p-16, 0x1.71df254c77156p-19, 0x1.28ad706015ad7p-22, 0x1.ad7f71e4d6022p-26};

/// e^r - 1 for |r| <= 0.3466, by Estrin's scheme: the latency of Horner's would be most of the time of an exponential.
///
/// g errs by 4 units of 2^-53 (sums of terms that shrink by 3 and more), r^2 g by 6, and the last sum by 1 of itself.
/// Relative to e^r - 1, of which r^2 g is at most 0.19, and of which the polynomial leaves out 0.5 units (a test
/// computes it): 2.7 units.
template <class Vector>
Vector exponential_less_1(const Vector& r) {
  const Vector r2 = r * r;
  const Vector r4 = r2 * r2;
  const auto two_terms = [&](std::size_t k) {
    return multiply_add(r, Vector(exponential_coefficients[k + 1]), Vector(exponential_coefficients[k]));
  };
  const auto four_terms = [&](std::size_t k) { return multiply_add(r2, two_terms(k + 2), two_terms(k)); };
  const Vector g = multiply_add(r4, multiply_add(r4, two_terms(8), four_terms(4)), four_terms(0));
  return multiply_add(r2, g, r);
}

/// Adding it leaves the nearest integer in the low bits, subtracting it again that integer.
inline constexpr double round_to_integer = 0x1.8p52;

/// |exponential(y) - e^y| <= exponential_error e^y for -700 <= y <= 700.
///
/// Proof, in units of 2^-53. With n the integer next to y log2(e), r = y - n ln 2 and |r| <= 0.3466: ln 2 = high + low,
/// n high is exact, the two subtractions err by 0.3466 each, so r errs by 0.7, and e^r by as much of itself. The
/// polynomial leaves out 0.1. r^2 g errs by 6, at most 0.41; r + r^2 g then by 0.41 + 0.42 for r > 0, 0.33 + 0.3 for
/// r < 0, and the last sum by 1 of itself. Relative to e^r, at least 0.707 for r < 0: 1.9 together. The sum,
/// 0.7 + 0.1 + 1.9, is below 3; 2^n is exact.
inline constexpr double exponential_error = 3 * unit_roundoff;

/// e^y for every lane (or for one number); y below -700 counts as -700. No table and no branch.
template <class Vector>
Vector exponential(const Vector& y) {
  constexpr double ln2_high = 0x1.62e42feep-1;  // 32 bits: its product with n is exact
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  const auto clamped = larger<Vector>(-700, y);
  const Vector shifted = multiply_add(clamped, Vector(std::numbers::log2e), Vector(round_to_integer));
  const Vector n = shifted - round_to_integer;
  const Vector r = multiply_add(n, Vector(-ln2_low), multiply_add(n, Vector(-ln2_high), clamped));
  const Vector e_to_r = 1.0 + exponential_less_1(r);
  return from_bits(to_bits(e_to_r) + (to_bits(shifted) << 52));
}

/// 2^y and 2^y - 1, each from the power of two nearest to 2^y and what 2^y is more than that, relative to it.
template <class Vector>
class PowerOf2 {
 public:
  /// Relative errors of the two, for |y| <= 1000.
  ///
  /// Proof, in units of 2^-53. r = ln 2 (y - n) errs by 2 of itself, |r| <= 0.3466, for y - n is exact; e^r - 1 by 2.4
  /// for r > 0 and 1.7 for r < 0 of itself from that, and by 2.7 of itself from its evaluation: 5.1 and 4.4. 2^n is
  /// exact. Relative to 2^y that is 0.293 * 5.1 or 0.415 * 4.4, and 1 for the sum: 2.9. Relative to 2^y - 1 it counts
  /// in full for n = 0, where the sum is exact; 0.71 * 5.1 for n = -1 and e^r = 1.414; 1.42 * 4.4 for n = 1 and e^r =
  /// 0.707; less for other n; and 1 for the sum: 7.3.
  static constexpr double error = 3 * unit_roundoff;
  static constexpr double error_less_1 = 8 * unit_roundoff;

  explicit PowerOf2(const Vector& y) {
    const Vector shifted = y + round_to_integer;
    const Vector fraction = y - (shifted - round_to_integer);
    power_ = from_bits((to_bits(shifted) << 52) + to_bits(Vector(1)));
    excess_ = exponential_less_1(Vector(std::numbers::ln2 * fraction));
  }

  [[nodiscard]] Vector value() const { return multiply_add(power_, excess_, power_); }
  [[nodiscard]] Vector less_1() const { return multiply_add(power_, excess_, power_ - 1.0); }

 private:
  Vector power_;
  Vector excess_;
};

/// ln(1 + g) = 2 q + q^3 P(q^2) for q = g / (2 + g), |q| <= 0.1716: P by interpolation at Chebyshev's points; the error
/// relative to the logarithm is below 2^-57 (a test computes it).
inline constexpr std::array<double, 7> logarithm_coefficients{
    0x1.5555555555558p-1, 0x1.99999999952b2p-2, 0x1.2492492df6947p-2, 0x1.c71c62debf86bp-3,
    0x1.7462b69705382p-3, 0x1.39fe208c33457p-3, 0x1.2b5b5fb2eac92p-3};

/// |minus_log(a, b) + ln(b)| <= minus_log_error |ln(b)| for 2^-1000 <= b <= 1.4 and a = 1 - b, as far as its two
/// arguments are exact.
///
/// Proof, in units of 2^-53. b = 2^k m, m in [0.707, 1.415). For k = 0, g = -a is exact: 2 + g errs by 1, q by 2 of
/// itself, 2 q + q^3 P by 2 + 0.1 + 1. For k < 0, |ln b| is at least 0.3466: ln m, at most 0.3466, errs by 3.1 of
/// itself, m - 1 being exact; k ln2_low and the first sum by less than 0.5 units of 0.3466, and the last sum by 1 of
/// itself: 5 in all.
inline constexpr double minus_log_error = 6 * unit_roundoff;

/// -ln(b) from b > 0 and from a = 1 - b, which has the digits where b is near 1.
template <class Vector>
Vector minus_log(const Vector& a, const Vector& b) {
  constexpr double ln2_high = 0x1.62e42feep-1;  // 32 bits: its product with k is exact
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  constexpr double square_root_of_half = 0x1.6a09e667f3bcdp-1;
  constexpr std::int64_t below_1 = 0x3ff0000000000000 - 0x3fe6a09e667f3bcd;
  constexpr std::int64_t two_to_52 = 0x4330000000000000;
  const auto shifted = to_bits(b) + to_bits(Vector(std::bit_cast<double>(below_1)));
  const Vector k = from_bits((shifted >> 52) | two_to_52) - (0x1p52 + 1023);
  const Vector m = from_bits((shifted & 0x000fffffffffffff) + to_bits(Vector(square_root_of_half)));
  const Vector g = select(magnitude(k) < Vector(0.5), Vector(0.0 - a), Vector(m - 1.0));
  const Vector q = g / (2.0 + g);
  const Vector z = q * q;
  const Vector z2 = z * z;
  const auto two_terms = [&](std::size_t i) {
    return multiply_add(z, Vector(logarithm_coefficients[i + 1]), Vector(logarithm_coefficients[i]));
  };
  const Vector last = multiply_add(z2, Vector(logarithm_coefficients[6]), two_terms(4));
  const Vector p = multiply_add(z2, multiply_add(z2, last, two_terms(2)), two_terms(0));
  const Vector log_m = multiply_add(q * z, p, 2.0 * q);
  return -multiply_add(k, Vector(ln2_high), multiply_add(k, Vector(ln2_low), log_m));
}

/// A number not below log2(x) and at most 0.09 above, for normal x > 0: the exponent, and the chord of the logarithm
/// between two powers of two, which lies at most 0.0861 below it.
template <class Vector>
Vector log2_above(const Vector& x) {
  constexpr std::int64_t two_to_52 = 0x4330000000000000;
  const Vector scaled = from_bits((to_bits(x) >> 12) | two_to_52);  // 2^52 + 2^40 (1023 + the chord)
  return multiply_add(scaled, Vector(0x1p-40), Vector(0.0862 - 1023 - 0x1p12));
}

/// A number not below 2^y (but for rounding, 2^-39 of it) and at most 1.07 times that, for y < 1024; y below -1000
/// counts as -1000. The chord of the power between two integers.
template <class Vector>
Vector power_of_2_above(const Vector& y) {
  return from_bits(to_bits(multiply_add(larger<Vector>(-1000, y), Vector(0x1p40), Vector(0x1p52 + 1023 * 0x1p40)))
                   << 12);
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
