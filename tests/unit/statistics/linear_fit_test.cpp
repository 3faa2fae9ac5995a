#include "raytruth/statistics/linear_fit.hpp"
#include "raytruth/statistics/grid_interpolation.hpp"

#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

TEST(LinearFit, OfAPlane) {
  std::vector<Observation> plane;
  for (const double x : {0.0, 1.0, 2.0})
    for (const double y : {0.0, 3.0, 5.0}) plane.push_back({{x, y}, 2 - x + 4 * y});
  const LinearFit fit = fit_linear(plane);
  ASSERT_EQ(fit.coefficients.size(), 3);
  EXPECT_NEAR(fit.coefficients[0], 2, 1e-13);
  EXPECT_NEAR(fit.coefficients[1], -1, 1e-13);
  EXPECT_NEAR(fit.coefficients[2], 4, 1e-13);
  EXPECT_NEAR(fit({-7, 0.5}), 11, 1e-12);
}

TEST(LinearFit, ByTheClosedFormOfALine) {
  // Means 2 and 4; about them squares of x add up to 6, products to 6.
  const LinearFit fit = fit_linear({{{1}, 2}, {{1}, 4}, {{4}, 6}});
  EXPECT_NEAR(fit.coefficients[1], 1, 1e-14);
  EXPECT_NEAR(fit.coefficients[0], 2, 1e-14);
}

TEST(LinearFit, WithoutFeaturesIsTheMean) { EXPECT_DOUBLE_EQ(fit_linear({{{}, 1}, {{}, 2}, {{}, 6}})({}), 3); }

TEST(LinearFit, LeavingOneOutAgreesWithItsLeverage) {
  // The residual of an observation that was left out is e / (1 - l) of the residual e of the whole fit, with the
  // leverage l = 1/n + (x - mean)^2 / sum of squares about it.
  const std::vector<std::pair<double, double>> points{{0, 1}, {1, 0}, {2, 4}, {5, 3}, {7, 9}};
  std::vector<Observation> all;
  for (const auto& [x, y] : points) all.push_back({{x}, y});
  const LinearFit whole = fit_linear(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<Observation> others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto [x, y] = points[i];
    const double leverage = 1.0 / 5 + (x - 3) * (x - 3) / (9 + 4 + 1 + 4 + 16);
    EXPECT_NEAR(y - fit_linear(others)({x}), (y - whole({x})) / (1 - leverage), 1e-12);
  }
}

TEST(LinearFit, SharesTheWeightOfEqualFeatures) {
  const LinearFit fit = fit_linear({{{0, 0}, 1}, {{1, 1}, 3}, {{2, 2}, 5}});
  EXPECT_NEAR(fit.coefficients[1], 1, 1e-13);
  EXPECT_NEAR(fit.coefficients[2], 1, 1e-13);
}

TEST(LinearFit, RefusesWhatCannotBeFitted) {
  EXPECT_THROW(fit_linear({}), InputError);
  EXPECT_THROW(fit_linear({{{1}, 2}, {{1, 2}, 3}}), InputError);
}

TEST(GridInterpolation, IsBilinearOnAGrid) {
  // A bilinear function is what it interpolates.
  const auto f = [](double x, double y) { return 1 + 2 * x - 3 * y + 0.5 * x * y; };
  std::vector<PlaneValue> values;
  for (const double x : {0.0, 1.0, 4.0})
    for (const double y : {-1.0, 2.0}) values.push_back({x, y, f(x, y)});
  const GridInterpolation plane(values);
  for (const double x : {0.0, 0.5, 1.0, 3.0, 4.0})
    for (const double y : {-1.0, 0.0, 2.0}) EXPECT_NEAR(plane(x, y), f(x, y), 1e-14);
}

TEST(GridInterpolation, IsConstantBeyondItsEdges) {
  const GridInterpolation plane({{0, 0, 1}, {2, 0, 3}, {0, 1, 5}, {2, 1, 7}});
  EXPECT_EQ(plane(-1, 0), 1);
  EXPECT_EQ(plane(3, 9), 7);
  EXPECT_EQ(plane(1, -4), 2);
}

TEST(GridInterpolation, TakesTheMeanOfSeveralValuesAtAPlace) {
  EXPECT_DOUBLE_EQ(GridInterpolation({{1, 1, 2}, {1, 1, 3}, {1, 1, 7}})(0, 0), 4);
}

TEST(GridInterpolation, NeedsNoFullGrid) {
  // The line of y = 0 has one place only.
  const GridInterpolation plane({{1, 0, 2}, {0, 4, 4}, {2, 4, 8}});
  EXPECT_DOUBLE_EQ(plane(2, 2), 5);
  EXPECT_THROW(GridInterpolation({}), InputError);
}

}  // namespace
}  // namespace raytruth
