#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/transfer/emission.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

TransferPoint point(double s, double extinction, double color = 1) { return {s, {extinction, {color, color, color}}}; }

TEST(ClearScalars, OfATent) {
  const ClearScalars clear(PiecewiseLinear({point(0.4, 0), point(0.5, 1), point(0.6, 0)}), Emission::associated);
  EXPECT_TRUE(clear.contain(-1e300, 0.4));
  EXPECT_TRUE(clear.contain(0.6, 1e300));
  EXPECT_FALSE(clear.contain(0.4, 0.41));
  EXPECT_FALSE(clear.contain(0.3, 0.7));
  EXPECT_FALSE(clear.contain(0.59, 0.6));
}

TEST(ClearScalars, AtJumpsTheValueFromTheRightCounts) {
  const ClearScalars clear(PiecewiseLinear({point(0.5, 0), point(0.5, 1), point(0.6, 1), point(0.6, 0)}),
                           Emission::associated);
  EXPECT_TRUE(clear.contain(0, 0.4999));
  EXPECT_FALSE(clear.contain(0.5, 0.5));
  EXPECT_TRUE(clear.contain(0.6, 0.6));
  EXPECT_FALSE(clear.contain(0.5999, 0.6));
}

TEST(ClearScalars, JoinAcrossPoints) {
  const ClearScalars clear(
      PiecewiseLinear({point(0, 1), point(0.1, 0), point(0.2, 0, 0.5), point(0.2, 0), point(0.3, 0)}),
      Emission::associated);
  EXPECT_TRUE(clear.contain(0.1, 7));
  EXPECT_FALSE(clear.contain(0.05, 0.2));
}

TEST(ClearScalars, PlainEmissionShinesWithoutExtinction) {
  const PiecewiseLinear transfer({point(0, 0, 0), point(1, 0, 1)});
  EXPECT_TRUE(ClearScalars(transfer, Emission::associated).contain(0, 1));
  EXPECT_FALSE(ClearScalars(transfer, Emission::plain).contain(0, 1));
  EXPECT_TRUE(ClearScalars(transfer, Emission::plain).contain(-1, 0));
}

}  // namespace
}  // namespace raytruth
