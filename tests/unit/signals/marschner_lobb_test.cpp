#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

TEST(MarschnerLobb, ClosedFormAtSpecialPoints) {
  // r = 0: cos(12 pi) = 1; r = 1: cos(0) = 1.
  EXPECT_NEAR(marschner_lobb(0, 0, 0), 1.5 / 2.5, 1e-15);
  EXPECT_NEAR(marschner_lobb(1, 0, 0), 1.5 / 2.5, 1e-15);
  EXPECT_NEAR(marschner_lobb(0, 0, 1), 0.5 / 2.5, 1e-15);
  EXPECT_NEAR(marschner_lobb(0, 0, -1), 1, 1e-15);
}

TEST(MarschnerLobb, SamplesLieOnItsNodes) {
  const Grid grid = sampled_marschner_lobb(41);
  EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{41, 41, 41}));
  EXPECT_EQ(grid.at(3, 40, 17), marschner_lobb(2 * 3 / 40.0 - 1, 1, 2 * 17 / 40.0 - 1));
  // As distributed, in 8 bits: 212 = floor(255 rho) at the first corner.
  EXPECT_EQ(static_cast<int>(255 * grid.at(0, 0, 0)), 212);
  const auto [low, high] = grid.range();
  EXPECT_GE(low, 0);
  EXPECT_LE(high, 1);
  EXPECT_THROW(sampled_marschner_lobb(1), InputError);
}

}  // namespace
}  // namespace raytruth
