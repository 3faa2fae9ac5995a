#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace raytruth {
namespace {

/// sum_k a_k x^k in 50 digits.
Real50 power_value(const std::vector<double>& coefficients, const Real50& x) {
  return std::accumulate(coefficients.rbegin(), coefficients.rend(), Real50(0),
                         [&x](const Real50& sum, double a) { return Real50(sum * x + a); });
}

TEST(BernsteinFromPowers, IsTheSamePolynomialToTheLastBits) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const auto random = [trial](std::uint32_t i) { return random_numbers(7, RandomStream::points, trial, i)[0]; };
    std::vector<double> coefficients(1 + trial % 10);
    for (std::uint32_t k = 0; k < coefficients.size(); ++k) coefficients[k] = 2 * random(k) - 1;
    const double length = 0.1 + 3 * random(20);
    const auto polynomial = bernstein_from_powers(coefficients, length);
    double largest = 0;
    for (const double b : polynomial.coefficients) largest = std::max(largest, std::abs(b));
    EXPECT_EQ(polynomial.coefficients.front(), coefficients.front());
    EXPECT_EQ(polynomial.coefficients.back(), to_double(power_value(coefficients, length)));
    for (const double u : {0.125, 0.5, 0.75}) {
      const double truth = to_double(power_value(coefficients, Real50(u) * length));
      EXPECT_NEAR(polynomial.value(u), truth, 16 * largest * std::numeric_limits<double>::epsilon());
    }
  }
}

TEST(PiecewisePolynomial, PutsPiecesBehindEachOther) {
  const auto chain = piecewise_polynomial({0, 1, 2.5}, {{0.1, 0.5}, {0.6, -0.2, 0.05, 0.01}});
  EXPECT_EQ(chain.length(), 2.5);
  EXPECT_DOUBLE_EQ(chain.value(0.5), 0.35);
  EXPECT_DOUBLE_EQ(chain.value(2), 0.6 - 0.2 + 0.05 + 0.01);
  EXPECT_EQ(chain.value(0.0), 0.1);
}

TEST(PiecewisePolynomial, MayJumpAndThenTheRightHandValueCounts) {
  const auto chain = piecewise_polynomial({0, 1, 2}, {{1}, {5}});
  EXPECT_EQ(chain.value(1.0), 5);
  EXPECT_EQ(chain.value(0.999), 1);
}

TEST(PiecewisePolynomial, RefusesWhatIsNone) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(piecewise_polynomial({}, {}), InputError);
  EXPECT_THROW(piecewise_polynomial({0}, {}), InputError);
  EXPECT_THROW(piecewise_polynomial({1, 2}, {{1}}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, 0}, {{1}}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, 2, 1}, {{1}, {1}}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, infinity}, {{1}}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, 1}, {}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, 1}, {{}}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, 1}, {std::vector<double>(11, 1.0)}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, 10}, {{0, 1e308}}), InputError);
  EXPECT_THROW(piecewise_polynomial({0, 1}, {{infinity}}), InputError);
}

}  // namespace
}  // namespace raytruth
