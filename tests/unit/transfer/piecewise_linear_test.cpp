#include "raytruth/transfer/piecewise_linear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace raytruth {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TransferPoint point(double s, double extinction, double color = 0) {
  return {s, {extinction, Vector3<double>::Constant(color)}};
}

/// Index and message of the PointError that refuses these points.
std::pair<std::size_t, std::string> refusal(const std::vector<TransferPoint>& points) {
  try {
    PiecewiseLinear transfer(points);
  } catch (const PointError& error) {
    return {error.index, error.what()};
  }
  return {points.size(), "accepted"};
}

TEST(PiecewiseLinear, IsLinearBetweenPointsAndConstantBeyond) {
  const PiecewiseLinear transfer({point(1, 2, 0), point(3, 6, 1)});
  EXPECT_EQ(transfer.at(1).extinction, 2);
  EXPECT_EQ(transfer.at(2.5).extinction, 5);
  EXPECT_EQ(transfer.at(2.5).color[2], 0.75);
  EXPECT_EQ(transfer.at(3).extinction, 6);
  EXPECT_EQ(transfer.at(-100).extinction, 2);
  EXPECT_EQ(transfer.at(100).extinction, 6);
}

TEST(PiecewiseLinear, TakesTheRightHandValueAtAJump) {
  const PiecewiseLinear transfer({point(0, 0), point(0.5, 1), point(0.5, 7), point(1, 8)});
  EXPECT_EQ(transfer.at(0.5).extinction, 7);
  EXPECT_NEAR(transfer.at(std::nextafter(0.5, 0)).extinction, 1, 1e-15);
  const PiecewiseLinear step({point(0.5, 0), point(0.5, 3)});
  EXPECT_EQ(step.at(0.4).extinction, 0);
  EXPECT_EQ(step.at(0.5).extinction, 3);
  EXPECT_EQ(step.at(0.6).extinction, 3);
}

TEST(PiecewiseLinear, SpansTheWholeRangeOfBinary64) {
  const double largest = std::numeric_limits<double>::max();
  const PiecewiseLinear transfer({point(-largest, 0), point(largest, 4)});
  EXPECT_EQ(transfer.at(0).extinction, 2);
}

TEST(PiecewiseLinear, RefusesBadPoints) {
  EXPECT_THROW(PiecewiseLinear({}), InputError);
  EXPECT_EQ(refusal({point(0, 1), point(1, 1)}).second, "accepted");
  EXPECT_EQ(refusal({point(0, 1), point(-1, 1)}).first, 1U);
  EXPECT_EQ(refusal({point(0, 1), point(0, 2), point(0, 3)}).first, 2U);
  EXPECT_EQ(refusal({point(0, 1), point(nan, 1)}).first, 1U);
  EXPECT_EQ(refusal({point(infinity, 1)}).first, 0U);
  EXPECT_EQ(refusal({point(0, 1), point(1, -1)}).second, "found extinction -1; a finite number >= 0 is allowed");
  EXPECT_EQ(refusal({point(0, nan)}).first, 0U);
  EXPECT_EQ(refusal({point(0, 1, -0.5)}).second, "found color [-0.5, -0.5, -0.5]; finite numbers >= 0 are allowed");
  EXPECT_EQ(refusal({point(0, 1, infinity)}).first, 0U);
}

TEST(FromOpacity, InterpolatesOpacityAndConvertsThen) {
  const Vector3<double> red{1, 0, 0};
  const Vector3<double> blue{0, 0, 1};
  const double unit_length = 0.5;
  const PiecewiseLinear transfer = from_opacity({{0, 0, red}, {1, 0.9, blue}}, unit_length);
  EXPECT_TRUE(transfer.is_linear_in_opacity());
  EXPECT_EQ(transfer.points().size(), 2U);
  EXPECT_EQ(transfer.unit_length(), unit_length);
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    EXPECT_NEAR(transfer.at(s).extinction, -std::log1p(-0.9 * s) / unit_length, 2e-15);
    EXPECT_NEAR(transfer.opacity_at(s), 0.9 * s, 1e-16);
    EXPECT_DOUBLE_EQ(transfer.at(s).color[2], s);
  }
  // Neither a faint opacity nor the rest of a strong one loses digits.
  EXPECT_DOUBLE_EQ(transfer.at(1e-20).extinction, 0.9e-20 / unit_length);
  const PiecewiseLinear whole = from_opacity({{0, 0, red}, {1, 1, blue}}, 1);
  EXPECT_DOUBLE_EQ(whole.at(1 - 0x1p-50).extinction, 50 * std::log(2));
  EXPECT_EQ(whole.at(1).extinction, opaque_extinction);
  EXPECT_EQ(whole.at(7).extinction, opaque_extinction);
}

TEST(FromOpacity, KeepsJumps) {
  const Vector3<double> black = Vector3<double>::Zero();
  const PiecewiseLinear transfer = from_opacity({{0, 0, black}, {1, 0.5, black}, {1, 0.2, black}, {2, 0.3, black}}, 1);
  EXPECT_DOUBLE_EQ(transfer.at(1).extinction, -std::log(0.8));
  EXPECT_DOUBLE_EQ(transfer.before(1).extinction, -std::log(0.5));
  EXPECT_EQ(transfer.opacity_at(1), 0.2);
  EXPECT_EQ(transfer.opacity_before(1), 0.5);
  EXPECT_EQ(transfer.opacity_before(2), 0.3);
}

TEST(Clamped, IsTheSameInside) {
  const Vector3<double> red{1, 0, 0};
  const std::vector<OpacityPoint> points{{0, 0, red}, {1, 0.5, red}, {1, 0.2, red}, {2, 0.6, red}};
  for (const PiecewiseLinear& transfer :
       {from_opacity(points, 2), PiecewiseLinear({{0, {0, red}}, {1, {2, red}}, {1, {1, red}}, {2, {3, red}}})}) {
    const PiecewiseLinear part = clamped(transfer, 0.5, 1.5);
    for (const double s : {0.5, 0.75, 1.0, 1.25, 1.5})
      EXPECT_DOUBLE_EQ(part.at(s).extinction, transfer.at(s).extinction);
    EXPECT_DOUBLE_EQ(part.at(0).extinction, transfer.at(0.5).extinction);
    EXPECT_DOUBLE_EQ(part.at(9).extinction, transfer.at(1.5).extinction);
    // What is met from below only.
    EXPECT_DOUBLE_EQ(clamped(transfer, 0, 1).at(1).extinction, transfer.before(1).extinction);
    EXPECT_TRUE((whitened(transfer).at(0.3).color == 1).all());
    EXPECT_EQ(whitened(transfer).at(0.3).extinction, transfer.at(0.3).extinction);
  }
}

TEST(LinearInExtinction, IsAChordOf1024) {
  const Vector3<double> red{1, 0, 0};
  const double unit_length = 0.5;
  const PiecewiseLinear exact = from_opacity({{0, 0, red}, {1, 0.9, red}}, unit_length);
  const PiecewiseLinear transfer = linear_in_extinction(exact);
  EXPECT_FALSE(transfer.is_linear_in_opacity());
  EXPECT_EQ(transfer.points().size(), 1025U);
  // Between its points the error of a chord: h^2 / 8 times the second derivative (0.9 / (1 - 0.9 s))^2 / unit_length.
  double largest = 0;
  for (int i = 0; i < 10000; ++i)
    largest = std::max(largest, std::abs(transfer.at(i / 10000.0).extinction - exact.at(i / 10000.0).extinction));
  EXPECT_LT(largest, 81 / unit_length / 8 / 1024 / 1024);
  EXPECT_GT(largest, 0.9 * 81 / unit_length / 8 / 1024 / 1024);
}

TEST(LinearInExtinction, ClampsFullOpacity) {
  const PiecewiseLinear transfer =
      linear_in_extinction(from_opacity({{0, 0, Vector3<double>::Zero()}, {1, 1, Vector3<double>::Zero()}}, 1));
  EXPECT_DOUBLE_EQ(transfer.at(1).extinction, 12 * std::log(2));
}

TEST(LinearInExtinction, StaysSmallAndNarrow) {
  const Vector3<double> black = Vector3<double>::Zero();
  std::vector<OpacityPoint> points;
  for (int i = 0; i < 4096; ++i) points.push_back({static_cast<double>(i), i % 2 == 0 ? 0.2 : 0.7, black});
  EXPECT_LE(linear_in_extinction(from_opacity(points, 1)).points().size(), 16U * 4096U);
  // Neighbours in binary64 leave no room; equal opacities need none.
  const double next = std::nextafter(1.0, 2.0);
  EXPECT_EQ(
      linear_in_extinction(from_opacity({{0, 0.5, black}, {1, 0.5, black}, {next, 0.3, black}}, 1)).points().size(),
      3U);
}

TEST(FromOpacity, RefusesBadPoints) {
  const Vector3<double> black = Vector3<double>::Zero();
  EXPECT_THROW(from_opacity({}, 1), InputError);
  EXPECT_THROW(from_opacity({{0, 1.5, black}}, 1), PointError);
  EXPECT_THROW(from_opacity({{0, nan, black}}, 1), PointError);
  EXPECT_THROW(from_opacity({{0, 0.5, black}}, 0), InputError);
  EXPECT_THROW(from_opacity({{1, 0.5, black}, {0, 0.5, black}}, 1), PointError);
}

}  // namespace
}  // namespace raytruth
