#include "raytruth/statistics/order.hpp"
#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

TEST(FittedOrder, OfAPower) {
  const FittedOrder fit = fit_order({{0.5, 3 * 0.125}, {0.25, 3 * 0.015625}, {0.125, 3 * 0.001953125}});
  EXPECT_NEAR(fit.order, 3, 1e-14);
  EXPECT_NEAR(fit.residual, 0, 1e-14);
}

TEST(FittedOrder, ResidualIsTheDistanceFromTheLine) {
  // log2 errors 0, 1, 0 over log2 steps 0, 1, 2: slope 0, about the mean 1/3.
  const FittedOrder fit = fit_order({{1, 1}, {2, 2}, {4, 1}});
  EXPECT_NEAR(fit.order, 0, 1e-15);
  EXPECT_NEAR(fit.residual, std::sqrt(2.0) / 3, 1e-15);
}

TEST(FittedOrder, RefusesWhatHasNone) {
  EXPECT_THROW(fit_order({{1, 1}}), InputError);
  EXPECT_THROW(fit_order({{1, 1}, {1, 2}}), InputError);
  EXPECT_THROW(fit_order({{1, 1}, {2, 0}}), InputError);
  EXPECT_THROW(fit_order({{0, 1}, {2, 1}}), InputError);
}

}  // namespace
}  // namespace raytruth
