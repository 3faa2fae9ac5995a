#include "raytruth/statistics/statistics.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

TEST(Quantile, IsType7) {
  // R: quantile(c(1, 2, 4, 8), c(0, .05, .25, .5, .9, 1), type = 7).
  const std::vector<double> values{1, 2, 4, 8};
  EXPECT_DOUBLE_EQ(quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(quantile(values, 0.05), 1.15);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 3);
  EXPECT_DOUBLE_EQ(quantile(values, 0.9), 6.8);
  EXPECT_DOUBLE_EQ(quantile(values, 1), 8);
  EXPECT_DOUBLE_EQ(quantile({5}, 0.3), 5);
}

TEST(Percentile, IsTheShareBelowPlusHalfTheTies) {
  const std::vector<double> values{1, 2, 2, 2, 3};
  EXPECT_DOUBLE_EQ(percentile_of(values, 0), 0);
  EXPECT_DOUBLE_EQ(percentile_of(values, 1), 0.1);
  EXPECT_DOUBLE_EQ(percentile_of(values, 1.5), 0.2);
  EXPECT_DOUBLE_EQ(percentile_of(values, 2), 0.5);
  EXPECT_DOUBLE_EQ(percentile_of(values, 9), 1);
}

}  // namespace
}  // namespace raytruth
