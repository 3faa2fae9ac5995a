#include "raytruth/shading/lit_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <gtest/gtest.h>

#include <boost/math/special_functions/gamma.hpp>

#include <cmath>
#include <limits>

namespace raytruth {
namespace {

/// Extinction 1 and white for every scalar.
PiecewiseLinear white() { return PiecewiseLinear({{0, {1, {1, 1, 1}}}}); }

LitSum lit_unit_length(double (*brightness)(double u)) {
  LitIntegral<3> integral(white(), Emission::associated);
  LitSum sum;
  integral.add(
      {}, 1, {}, [brightness](double u, double /*slope*/) { return PointLight{.matter = brightness(u)}; }, sum);
  return sum;
}

TEST(LitIntegral, OfAPowerIsAnIncompleteGammaFunction) {
  const double truth = boost::math::tgamma_lower(51.0, 1.0);
  const LitSum sum = lit_unit_length([](double u) { return std::pow(u, 50); });
  EXPECT_NEAR(sum.color[0], truth, 1e-10);
  EXPECT_TRUE(sum.is_resolved);
  EXPECT_DOUBLE_EQ(sum.opacity(), -std::expm1(-1));
}

TEST(LitIntegral, OfLightOfManyPowersOfTenEndsAndKeepsItsDigits) {
  // As curves between nearly opposite normals make it. An absolute tolerance would halve panels for years.
  const double truth = 1e12 * boost::math::tgamma_lower(51.0, 1.0);
  const LitSum sum = lit_unit_length([](double u) { return 1e12 * std::pow(u, 50); });
  EXPECT_NEAR(sum.color[0], truth, 1e-9 * truth);
  EXPECT_TRUE(sum.is_resolved);
}

TEST(LitIntegral, OfLightThatOverflowsEnds) {
  const LitSum sum = lit_unit_length([](double) { return std::numeric_limits<double>::infinity(); });
  EXPECT_FALSE(std::isfinite(sum.color[0]));
  EXPECT_FALSE(sum.is_resolved);
}

}  // namespace
}  // namespace raytruth
