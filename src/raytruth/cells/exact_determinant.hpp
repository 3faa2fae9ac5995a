#pragma once

#include "raytruth/core/double_double.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <cmath>

namespace raytruth {

/// det(a, b, c) of vectors in 106 bits, and what it may be off by.
struct Determinant {
  DoubleDouble value;
  double error = 0;

  /// -1 or 1, or 0 where the rounding hides it.
  [[nodiscard]] int sign() const {
    if (std::abs(value.high) <= error) return 0;
    return value.high > 0 ? 1 : -1;
  }
};

using Vector106 = std::array<DoubleDouble, 3>;
using ExactNumber = boost::multiprecision::cpp_rational;
using ExactVector = std::array<ExactNumber, 3>;

/// a - b, without rounding.
inline Vector106 difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {two_sum(a[0], -b[0]), two_sum(a[1], -b[1]), two_sum(a[2], -b[2])};
}

inline ExactVector exact_difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {ExactNumber(a[0]) - ExactNumber(b[0]), ExactNumber(a[1]) - ExactNumber(b[1]),
          ExactNumber(a[2]) - ExactNumber(b[2])};
}

inline Determinant determinant(const Vector106& a, const Vector106& b, const Vector106& c) {
  Determinant result;
  double magnitude = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const DoubleDouble p = b[j] * c[k];
    const DoubleDouble q = b[k] * c[j];
    result.value += a[i] * (p - q);
    magnitude += std::abs(a[i].high) * (std::abs(p.high) + std::abs(q.high));
  }
  // Each term passes through six operations of 2^-102, and what underflows is far below the last number.
  result.error = 0x1p-98 * magnitude + 0x1p-900;
  return result;
}

inline ExactNumber determinant(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The number in 106 bits, to a relative 2^-104.
inline DoubleDouble to_106_bits(const ExactNumber& number) {
  const auto high = number.convert_to<double>();
  const ExactNumber rest = number - ExactNumber(high);
  return fast_two_sum(high, rest.convert_to<double>());
}

}  // namespace raytruth
