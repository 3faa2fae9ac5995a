#pragma once

#include "raytruth/core/double_double.hpp"

#include <cmath>

namespace raytruth {

/// Four DoubleDouble side by side, as compilers know vectors. Products are those of DoubleDouble; sums are shorter: off
/// by less than 2^-102 (|a| + |b|), which where terms cancel is more than 2^-102 of the result.
struct DoubleDouble4 {
  using Vector [[gnu::vector_size(4 * sizeof(double))]] = double;

  Vector high{};
  Vector low{};

  [[nodiscard]] DoubleDouble operator[](int lane) const { return {high[lane], low[lane]}; }
};

inline DoubleDouble4 fast_two_sum(const DoubleDouble4::Vector& a, const DoubleDouble4::Vector& b) {
  const auto sum = a + b;
  return {sum, b - (sum - a)};
}

inline DoubleDouble4 two_sum(const DoubleDouble4::Vector& a, const DoubleDouble4::Vector& b) {
  const auto sum = a + b;
  const auto b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

inline DoubleDouble4 operator+(const DoubleDouble4& a, const DoubleDouble4& b) {
  const DoubleDouble4 sum = two_sum(a.high, b.high);
  return fast_two_sum(sum.high, sum.low + (a.low + b.low));
}

inline DoubleDouble4 operator-(const DoubleDouble4& a, const DoubleDouble4& b) {
  return a + DoubleDouble4{-b.high, -b.low};
}

/// a * b, a being exact.
inline DoubleDouble4 product(const DoubleDouble4::Vector& a, const DoubleDouble& b) {
  const auto high = a * b.high;
  DoubleDouble4::Vector rest{};
  for (int lane = 0; lane < 4; ++lane) rest[lane] = std::fma(a[lane], b.high, -high[lane]);
  return fast_two_sum(high, rest + a * b.low);
}

inline DoubleDouble4 operator*(const DoubleDouble4& a, const DoubleDouble& b) {
  const auto product = a.high * b.high;
  DoubleDouble4::Vector rest{};
  for (int lane = 0; lane < 4; ++lane) rest[lane] = std::fma(a.high[lane], b.high, -product[lane]);
  return fast_two_sum(product, rest + (a.high * b.low + a.low * b.high));
}

}  // namespace raytruth
