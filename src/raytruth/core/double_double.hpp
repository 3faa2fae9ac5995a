#pragma once

#include <cmath>
#include <compare>
#include <type_traits>

namespace raytruth {

/// An unevaluated sum high + low with |low| <= ulp(high)/2: about 106 bits.
///
/// Abscissae along a ray are of this type. With binary64 alone a cell border at t = 10^6 voxels is misplaced by 10^-10,
/// and so is everything that the signal does behind it.
///
/// Additions and products are Dekker's and Knuth's error-free transformations (T. J. Dekker, A floating-point technique
/// for extending the available precision, 1971); the relative error of each operation is below 2^-102.
struct DoubleDouble {
  double high = 0;
  double low = 0;

  constexpr DoubleDouble() = default;
  // Implicit: a binary64 number is exactly such a sum.
  constexpr DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor)
  constexpr DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}

  [[nodiscard]] explicit constexpr operator double() const { return high + low; }

  // Normalised sums order as their parts do, first the high one.
  friend constexpr auto operator<=>(const DoubleDouble&, const DoubleDouble&) = default;
};

/// a + b exactly, for |a| >= |b| or a = 0.
constexpr DoubleDouble fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b exactly.
constexpr DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a * b exactly, short of underflow.
inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

constexpr DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high);
  const DoubleDouble low = two_sum(a.low, b.low);
  const DoubleDouble sum = fast_two_sum(high.high, high.low + low.high);
  return fast_two_sum(sum.high, sum.low + low.low);
}

constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }

constexpr DoubleDouble& operator+=(DoubleDouble& a, const DoubleDouble& b) { return a = a + b; }

inline DoubleDouble operator*(const DoubleDouble& a, double b) {
  const DoubleDouble product = two_product(a.high, b);
  return fast_two_sum(product.high, product.low + a.low * b);
}

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// a / b; infinite where the quotient overflows.
inline DoubleDouble operator/(const DoubleDouble& a, double b) {
  const double quotient = a.high / b;
  if (!std::isfinite(quotient)) return quotient;
  const double remainder = std::fma(-quotient, b, a.high) + a.low;
  return fast_two_sum(quotient, remainder / b);
}

/// The largest integer not above a. A sum just below an integer may have it as its high part.
inline double floor(const DoubleDouble& a) {
  const double floor = std::floor(a.high);
  return floor == a.high && a.low < 0 ? floor - 1 : floor;
}

/// The type of abscissae that goes with an arithmetic.
template <class Real>
using Abscissa = std::conditional_t<std::is_same_v<Real, double>, DoubleDouble, Real>;

}  // namespace raytruth
