#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <limits>

namespace raytruth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Coefficients in [-1, 1].
template <int Degree>
Bernstein<Degree> random_polynomial(std::uint64_t index) {
  Bernstein<Degree> p;
  for (std::size_t i = 0; i <= Degree; ++i)
    p.coefficients[i] =
        2 * random_numbers(3, RandomStream::points, index, static_cast<std::uint32_t>(i / 4))[i % 4] - 1;
  return p;
}

template <int Degree>
Bernstein<Degree, Real50> in_50_digits(const Bernstein<Degree>& p) {
  Bernstein<Degree, Real50> result;
  std::copy(p.coefficients.begin(), p.coefficients.end(), result.coefficients.begin());
  return result;
}

/// The Bernstein coefficients of prod (u - root), by multiplying factor after factor.
template <int Degree>
Bernstein<Degree> from_roots(const std::array<double, Degree>& roots) {
  std::array<double, Degree + 1> b{1};
  for (std::size_t n = 0; n < Degree; ++n) {
    std::array<double, Degree + 1> product{};
    // u - r has the coefficients -r and 1 - r.
    for (std::size_t i = 0; i <= n; ++i) {
      product[i] += b[i] * -roots[n] * static_cast<double>(n + 1 - i) / static_cast<double>(n + 1);
      product[i + 1] += b[i] * (1 - roots[n]) * static_cast<double>(i + 1) / static_cast<double>(n + 1);
    }
    b = product;
  }
  return {b};
}

template <class Degree>
class BernsteinTest : public testing::Test {};
using Degrees =
    testing::Types<std::integral_constant<int, 0>, std::integral_constant<int, 1>, std::integral_constant<int, 2>,
                   std::integral_constant<int, 3>, std::integral_constant<int, 9>>;
TYPED_TEST_SUITE(BernsteinTest, Degrees);

TYPED_TEST(BernsteinTest, ValueIsTheSumOfTheBasis) {
  constexpr int degree = TypeParam::value;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto p = random_polynomial<degree>(i);
    for (const double u : {0.0, 0.125, 0.3, 0.5, 0.8, 1.0}) {
      Real50 sum = 0;
      Real50 binomial = 1;
      for (int k = 0; k <= degree; ++k) {
        sum += binomial * pow(Real50(u), k) * pow(1 - Real50(u), degree - k) *
               Real50(p.coefficients[static_cast<std::size_t>(k)]);
        binomial = binomial * (degree - k) / (k + 1);
      }
      EXPECT_NEAR(p.value(u), to_double(sum), 1.5 * degree * epsilon);
    }
    EXPECT_EQ(p.value(0), p.coefficients.front());
    EXPECT_EQ(p.value(1), p.coefficients.back());
  }
}

TYPED_TEST(BernsteinTest, PartsAreThePolynomial) {
  constexpr int degree = TypeParam::value;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto p = random_polynomial<degree>(i);
    const auto [left, right] = p.split(0.3);
    EXPECT_EQ(left.coefficients.back(), p.value(0.3));
    EXPECT_EQ(right.coefficients.front(), p.value(0.3));
    const auto part = p.restricted(0.2, 0.7);
    EXPECT_EQ(part.coefficients.front(), p.value(0.2));
    EXPECT_EQ(part.coefficients.back(), p.value(0.7));
    for (const double u : {0.1, 0.5, 0.9}) {
      EXPECT_NEAR(left.value(u), p.value(0.3 * u), 4 * (degree + 1) * epsilon);
      EXPECT_NEAR(right.value(u), p.value(0.3 + 0.7 * u), 4 * (degree + 1) * epsilon);
      EXPECT_NEAR(part.value(u), p.value(0.2 + 0.5 * u), 4 * (degree + 1) * epsilon);
    }
    EXPECT_EQ(p.restricted(0, 1), p);
    const auto backwards = p.restricted(0.7, 0.2);
    for (const double u : {0.0, 0.3, 1.0})
      EXPECT_NEAR(backwards.value(u), part.value(1 - u), 4 * (degree + 1) * epsilon);
  }
}

TYPED_TEST(BernsteinTest, DerivativeIntegralAndElevation) {
  constexpr int degree = TypeParam::value;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto p = in_50_digits(random_polynomial<degree>(i));
    const Real50 tiny("1e-45");
    const auto primitive = p.antiderivative();
    const auto again = primitive.derivative();
    for (std::size_t k = 0; k <= degree; ++k) EXPECT_LE(abs(again.coefficients[k] - p.coefficients[k]), tiny);
    EXPECT_EQ(primitive.coefficients.front(), 0);
    EXPECT_LE(abs(primitive.coefficients.back() - p.integral()), tiny);
    const auto higher = p.template elevated<degree + 3>();
    for (const char* u : {"0.1", "0.6"}) EXPECT_LE(abs(higher.value(Real50(u)) - p.value(Real50(u))), tiny);
  }
}

TYPED_TEST(BernsteinTest, ConstantsStayConstant) {
  constexpr int degree = TypeParam::value;
  Bernstein<degree> p;
  p.coefficients.fill(0.1);
  for (const double u : {0.1, 1.0 / 3, 0.77}) {
    EXPECT_EQ(p.value(u), 0.1);
    EXPECT_EQ(p.split(u).first, p);
    EXPECT_EQ(p.restricted(u / 2, u), p);
  }
}

TYPED_TEST(BernsteinTest, RangeEnclosesAndIsAttained) {
  constexpr int degree = TypeParam::value;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto p = random_polynomial<degree>(i);
    const auto [low, high] = p.range();
    double least = p.value(0);
    double most = least;
    for (int k = 0; k <= 2000; ++k) {
      const double value = p.value(k / 2000.0);
      least = std::min(least, value);
      most = std::max(most, value);
    }
    EXPECT_LE(low, least + degree * epsilon);
    EXPECT_GE(high, most - degree * epsilon);
    // Between two samples of the search a polynomial rises by at most |p''| h^2 / 8.
    const double slack = 4.0 * degree * degree / (8.0 * 2000 * 2000);
    EXPECT_GE(low, least - slack);
    EXPECT_LE(high, most + slack);
  }
}

TEST(SignChanges, FindsTheRootsItWasMadeOf) {
  const auto roots = from_roots<4>({0.125, 0.3, 0.31, 0.9}).sign_changes();
  ASSERT_EQ(roots.size(), 4U);
  const std::array expected{0.125, 0.3, 0.31, 0.9};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(roots[i], expected[i], 1e-13);
}

TEST(SignChanges, TouchingIsNoChange) {
  EXPECT_TRUE(from_roots<2>({0.5, 0.5}).sign_changes().empty());
  EXPECT_TRUE(from_roots<2>({0.3, 0.3}).sign_changes().empty());
  const auto through = from_roots<3>({0.3, 0.3, 0.3}).sign_changes();
  ASSERT_EQ(through.size(), 1U);
  // A triple root is known to the cube root of the rounding only.
  EXPECT_NEAR(through[0], 0.3, 2e-5);
}

TEST(SignChanges, RootsAtTheEndsAreNotInside) {
  const auto roots = from_roots<3>({0.0, 0.5, 1.0}).sign_changes();
  ASSERT_EQ(roots.size(), 1U);
  EXPECT_EQ(roots[0], 0.5);
  EXPECT_TRUE(from_roots<2>({0.0, 1.0}).sign_changes().empty());
  EXPECT_TRUE((Bernstein<3>{{0, 0, 0, 0}}.sign_changes().empty()));
  EXPECT_TRUE((Bernstein<3>{{0, 0, 0, 1}}.sign_changes().empty()));
}

TEST(SignChanges, AtTheMiddleOfTheBisection) {
  const auto roots = from_roots<3>({0.25, 0.5, 0.75}).sign_changes();
  ASSERT_EQ(roots.size(), 3U);
  EXPECT_NEAR(roots[0], 0.25, 1e-14);
  EXPECT_NEAR(roots[1], 0.5, 1e-14);
  EXPECT_NEAR(roots[2], 0.75, 1e-14);
}

TEST(SignChanges, NumberAgreesWithADenseSearch) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    const auto p = random_polynomial<9>(i);
    const auto roots = p.sign_changes();
    std::size_t changes = 0;
    double before = p.value(0);
    for (int k = 1; k <= 4096; ++k) {
      const double here = p.value(k / 4096.0);
      if (here * before < 0) ++changes;
      before = here;
    }
    // A pair of roots between two points of the search is not seen by it.
    EXPECT_GE(roots.size(), changes);
    EXPECT_EQ((roots.size() - changes) % 2, 0U);
    for (const double root : roots) EXPECT_NEAR(p.value(root), 0, 1e-14);
    EXPECT_TRUE(std::is_sorted(roots.begin(), roots.end()));
  }
}

TEST(IntegralOfMagnitude, AgreesWithAdaptiveQuadrature) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto p = random_polynomial<5>(i);
    const auto magnitude = [&p](double u) { return std::abs(p.value(u)); };
    // Many short intervals: the rule's own error estimate is blind to some kinks.
    using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;
    double quadrature = 0;
    for (int k = 0; k < 64; ++k) quadrature += Quadrature::integrate(magnitude, k / 64.0, (k + 1) / 64.0, 12, 1e-9);
    EXPECT_NEAR(p.integral_of_magnitude(), quadrature, 1e-9);
  }
}

TEST(IntegralOfMagnitude, AgreesWith50DigitsToRounding) {
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto p = random_polynomial<3>(i);
    const Real50 exact = in_50_digits(p).integral_of_magnitude();
    EXPECT_NEAR(p.integral_of_magnitude(), to_double(exact), 8 * epsilon);
  }
}

TEST(IntegralOfMagnitude, ClosedForm) {
  // |2u - 1| and |u (u - 1/2)(u - 1)|.
  EXPECT_EQ((Bernstein<1>{{-1, 1}}.integral_of_magnitude()), 0.5);
  EXPECT_NEAR(from_roots<3>({0.0, 0.5, 1.0}).integral_of_magnitude(), 1.0 / 32, epsilon);
}

}  // namespace
}  // namespace raytruth
