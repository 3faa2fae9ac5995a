#include "raytruth/core/real.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

TEST(Binary32, LiteralsRoundAsInAShader) {
  const Binary32 x(1.0 / 3.0);
  // In C++, 0.1 * float is a product in binary64; in GLSL it is not.
  EXPECT_EQ(to_double(0.1 * x), static_cast<double>(0.1F * (1.0F / 3.0F)));
  EXPECT_NE(to_double(0.1 * x), 0.1 * to_double(x));
}

TEST(Binary32, EveryOperationRounds) {
  const Binary32 a(16777216.0);  // 2^24
  EXPECT_EQ(to_double(a + Binary32(1.0)), 16777216.0);
  EXPECT_EQ(to_double((a + Binary32(2.0)) - a), 2.0);
  EXPECT_EQ(to_double(Binary32(1.0) / Binary32(3.0)), static_cast<double>(1.0F / 3.0F));
  EXPECT_LT(-a, a);
}

}  // namespace
}  // namespace raytruth
