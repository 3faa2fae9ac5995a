#include "raytruth/statistics/rank_correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

TEST(RankCorrelation, OfPairsCountedByHand) {
  // Ranks of y: 2 1 4 3 5; their differences from those of x: 1 1 1 1 0. rho = 1 - 6 * 4 / (5 * 24).
  // Two of ten pairs of pairs are discordant: tau = (8 - 2) / 10.
  const std::vector<double> x{1, 2, 3, 4, 5};
  const std::vector<double> y{0.2, 0.1, 70, 0.3, 900};
  EXPECT_NEAR(spearman(x, y)->estimate, 0.8, 1e-15);
  EXPECT_NEAR(kendall(x, y)->estimate, 0.6, 1e-15);
}

TEST(RankCorrelation, TiesCountHalf) {
  // Ranks of x: 1, 2.5, 2.5, 4, 5; of y: 1.5, 1.5, 3, 4, 5. Deviations from 3: -2 -.5 -.5 1 2 and -1.5 -1.5 0 1 2.
  // rho = 8.75 / sqrt(9.5 * 9.5). Pairs of pairs: 10, one tied in x, another in y, 8 concordant: tau-b = 8 / 9.
  const std::vector<double> x{0, 1, 1, 2, 3};
  const std::vector<double> y{4, 4, 5, 6, 7};
  EXPECT_NEAR(spearman(x, y)->estimate, 8.75 / 9.5, 1e-15);
  EXPECT_NEAR(kendall(x, y)->estimate, 8.0 / 9, 1e-15);
}

TEST(RankCorrelation, IsOneForEveryRisingAndMinusOneForEveryFallingFunction) {
  std::vector<double> x;
  std::vector<double> rising;
  std::vector<double> falling;
  for (int i = 0; i < 50; ++i) {
    x.push_back(std::sin(i));
    rising.push_back(std::exp(5 * x.back()));
    falling.push_back(-std::cbrt(x.back()));
  }
  for (const auto correlation : {spearman, kendall}) {
    EXPECT_EQ(correlation(x, rising)->estimate, 1);
    EXPECT_EQ(correlation(x, rising)->low, 1);
    EXPECT_EQ(correlation(x, falling)->estimate, -1);
  }
}

TEST(RankCorrelation, IntervalOfFiellerHartleyAndPearson) {
  // n = 5, rho = 0.8: tanh(atanh(0.8) +- 1.96 sqrt(1.06 / 2)); tau = 0.6: tanh(atanh(0.6) +- 1.96 sqrt(0.437)).
  const std::vector<double> x{1, 2, 3, 4, 5};
  const std::vector<double> y{2, 1, 4, 3, 5};
  EXPECT_NEAR(spearman(x, y)->low, std::tanh(std::atanh(0.8) - 1.42687), 1e-5);
  EXPECT_NEAR(spearman(x, y)->high, std::tanh(std::atanh(0.8) + 1.42687), 1e-5);
  EXPECT_NEAR(kendall(x, y)->low, std::tanh(std::atanh(0.6) - 1.29566), 1e-5);
  EXPECT_NEAR(kendall(x, y)->high, std::tanh(std::atanh(0.6) + 1.29566), 1e-5);
}

TEST(RankCorrelation, OfTooFewOrConstantValuesIsNone) {
  for (const auto correlation : {spearman, kendall}) {
    EXPECT_FALSE(correlation({1, 2, 3, 4}, {1, 2, 3, 4}));
    EXPECT_FALSE(correlation({1, 1, 1, 1, 1}, {1, 2, 3, 4, 5}));
    EXPECT_FALSE(correlation({1, 2, 3, 4, 5}, {1, 1, 1, 1, 1}));
  }
}

}  // namespace
}  // namespace raytruth
