#include "raytruth/core/double_double.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

using boost::multiprecision::abs;

Real50 exact(const DoubleDouble& x) { return Real50(x.high) + Real50(x.low); }

/// Numbers of very different sizes, with all bits of both parts in use.
DoubleDouble random_number(std::uint64_t index) {
  const auto u = random_numbers(7, RandomStream::points, index);
  const double high = (2 * u[0] - 1) * std::exp2(std::floor(60 * u[1]) - 30) * (1 + u[2] * 0x1p-25);
  return two_sum(high, high * (u[3] - 0.5) * 0x1p-53);
}

TEST(DoubleDouble, OperationsAgreeWith50Digits) {
  const Real50 bound = ldexp(Real50(1), -102);
  for (std::uint64_t i = 0; i < 20000; i += 2) {
    const DoubleDouble a = random_number(i);
    const DoubleDouble b = random_number(i + 1);
    // A sum may cancel: its error is relative to its terms.
    EXPECT_LE(abs(exact(a + b) - (exact(a) + exact(b))), bound * (abs(exact(a)) + abs(exact(b))));
    EXPECT_LE(abs(exact(a - b) - (exact(a) - exact(b))), bound * (abs(exact(a)) + abs(exact(b))));
    EXPECT_LE(abs(exact(a * b.high) - exact(a) * Real50(b.high)), bound * abs(exact(a) * Real50(b.high)));
    EXPECT_LE(abs(exact(a * b) - exact(a) * exact(b)), bound * abs(exact(a) * exact(b)));
    EXPECT_LE(abs(exact(a / b.high) - exact(a) / Real50(b.high)), bound * abs(exact(a) / Real50(b.high)));
  }
}

TEST(DoubleDouble, ErrorFreeTransformationsLoseNothing) {
  for (std::uint64_t i = 0; i < 20000; i += 2) {
    const double a = random_number(i).high;
    const double b = random_number(i + 1).high;
    EXPECT_EQ(exact(two_sum(a, b)), Real50(a) + Real50(b));
    EXPECT_EQ(exact(two_product(a, b)), Real50(a) * Real50(b));
  }
}

TEST(DoubleDouble, OrdersByBothParts) {
  EXPECT_LT(DoubleDouble(1, -0x1p-60), DoubleDouble(1));
  EXPECT_LT(DoubleDouble(1), DoubleDouble(1, 0x1p-60));
  EXPECT_EQ(DoubleDouble(1), DoubleDouble(1, 0));
}

TEST(DoubleDouble, QuotientThatOverflowsIsInfinite) { EXPECT_TRUE(std::isinf((DoubleDouble(1e300) / 1e-300).high)); }

}  // namespace
}  // namespace raytruth
