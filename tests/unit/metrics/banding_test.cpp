#include "raytruth/metrics/banding.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace raytruth {
namespace {

constexpr std::array<std::int64_t, 2> square{48, 48};

std::vector<double> image_of(const std::function<double(double column, double row)>& f) {
  std::vector<double> values;
  for (std::int64_t row = 0; row < square[1]; ++row)
    for (std::int64_t column = 0; column < square[0]; ++column)
      values.push_back(f(static_cast<double>(column), static_cast<double>(row)));
  return values;
}

double noise(double column, double row) {
  return random_numbers(1, RandomStream::points, static_cast<std::uint64_t>(row * 1000 + column))[0];
}

TEST(Autocorrelation, OfFourValuesComputedByHand) {
  // About their mean -3/2, -1/2, 3/2, 1/2; variance 5/4. Lag 1: (3/4 - 3/4 + 3/4)/3, lag 2: (-9/4 - 1/4)/2, lag 3:
  // -3/4.
  const auto r = autocorrelation({0, 1, 3, 2}, {4, 1}, {1, 0}, 3);
  ASSERT_EQ(r.size(), 4);
  EXPECT_DOUBLE_EQ(r[0], 1);
  EXPECT_DOUBLE_EQ(r[1], 0.25 / 1.25);
  EXPECT_DOUBLE_EQ(r[2], -1.25 / 1.25);
  EXPECT_DOUBLE_EQ(r[3], -0.75 / 1.25);
}

TEST(Autocorrelation, OnADiagonalOfTwoByTwo) {
  // About the mean 3/2: the falling diagonal joins -3/2 with 3/2, the rising one 1/2 with -1/2; variance 5/4.
  EXPECT_DOUBLE_EQ(autocorrelation({0, 1, 2, 3}, {2, 2}, {1, 1}, 1)[1], -2.25 / 1.25);
  EXPECT_DOUBLE_EQ(autocorrelation({0, 1, 2, 3}, {2, 2}, {1, -1}, 1)[1], -0.25 / 1.25);
}

TEST(Autocorrelation, OfAConstant) {
  EXPECT_EQ(autocorrelation({2, 2, 2}, {3, 1}, {1, 0}, 2), (std::vector<double>{1, 0, 0}));
}

TEST(Autocorrelation, OfASinusoidIsACosine) {
  // Over whole periods the mean product of two sinusoids a lag apart is cos(2 pi lag / period) / 2; the sum over the
  // pairs that are left differs from it by a part of a period, less than 1 / pairs of it.
  const auto wave = image_of([](double column, double) { return std::sin(2 * std::numbers::pi * column / 8); });
  const auto r = autocorrelation(wave, square, {1, 0}, 12);
  for (int lag = 0; lag <= 12; ++lag)
    EXPECT_NEAR(r[static_cast<std::size_t>(lag)], std::cos(2 * std::numbers::pi * lag / 8), 4.0 / (48 - 12)) << lag;
}

TEST(Banding, IsOneForStripesOfAnyDirection) {
  for (const auto& [x, y] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.7, 0.7}, {0.7, -0.7}}) {
    const auto stripes = image_of([x = x, y = y](double column, double row) {
      return 3 + 0.5 * std::sin(2 * std::numbers::pi * (x * column + y * row) / 8);
    });
    const Banding found = banding(stripes, square, 24);
    EXPECT_NEAR(found.share, 1, 0.05);
    EXPECT_NEAR(found.amplitude, 0.5 / std::numbers::sqrt2, 0.02);
  }
}

TEST(Banding, IsNoneForWhatVariesSmoothly) {
  EXPECT_EQ(banding(image_of([](double, double) { return 2; }), square, 24).share, 0);
  // A ramp's autocorrelation falls along every direction that it has a slope in, and stays at what it is across.
  EXPECT_LT(banding(image_of([](double column, double row) { return column + 2 * row; }), square, 24).share, 1e-12);
  EXPECT_LT(banding(image_of([](double column, double) { return std::exp(column / 16); }), square, 24).share, 1e-12);
}

TEST(Banding, IsSmallForNoise) {
  // 12 lags in 4 directions, each with a deviation of at most 1 / sqrt(12 * 12) by the fewest pairs: half the distance
  // of the extremes of so many is hardly above 2.5 deviations.
  const Banding found = banding(image_of(noise), square, 24);
  EXPECT_GT(found.share, 0.02);
  EXPECT_LT(found.share, 2.5 / 12);
}

TEST(Banding, OfStripesInNoiseIsTheirShare) {
  // Variances 1/12 of noise and 1/24 of stripes: stripes are a third.
  const auto both = image_of([](double column, double row) {
    return noise(column, row) + std::sin(2 * std::numbers::pi * column / 6) / std::sqrt(12);
  });
  const Banding found = banding(both, square, 24);
  EXPECT_GT(found.share, 1.0 / 3 - 0.05);
  EXPECT_LT(found.share, 1.0 / 3 + 2.5 / 12);
}

TEST(Banding, RefusesWindowsThatDoNotFit) {
  EXPECT_THROW(banding(image_of(noise), square, 49), InputError);
  EXPECT_THROW(banding(image_of(noise), square, 4), InputError);
}

}  // namespace
}  // namespace raytruth
