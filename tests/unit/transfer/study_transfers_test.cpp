#include "raytruth/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace raytruth {
namespace {

double extinction_at(const PiecewiseLinear& transfer, double s) { return transfer.at(s).extinction; }

TEST(StudyTransfers, HaveTheirShapes) {
  const auto ramp = ramp_transfer(8);
  for (const double s : {0.0, 0.25, 1.0}) EXPECT_EQ(extinction_at(ramp, s), 8 * s);
  const auto tent = tent_transfer(8);
  for (const auto& [s, extinction] : {std::pair{0.39, 0.0}, {0.45, 4.0}, {0.5, 8.0}, {0.55, 4.0}, {0.61, 0.0}})
    EXPECT_NEAR(extinction_at(tent, s), extinction, 1e-14);
  const auto isoslab = isoslab_transfer(8);
  for (const auto& [s, extinction] : {std::pair{0.498, 0.0}, {0.499, 8.0}, {0.5, 8.0}, {0.501, 8.0}, {0.502, 0.0}})
    EXPECT_EQ(extinction_at(isoslab, s), extinction);
  const auto step = step_transfer(8);
  for (const auto& [s, extinction] : {std::pair{0.0, 0.0}, {std::nextafter(0.5, 0), 0.0}, {0.5, 8.0}, {1.0, 8.0}})
    EXPECT_EQ(extinction_at(step, s), extinction);
}

TEST(StudyTransfers, GaussianIsOneToTheChordOfItsTable) {
  // |f - chord| <= max |f''| h^2 / 8, and |f''| <= extinction / deviation^2.
  const auto gaussian = gaussian_transfer(8);
  ASSERT_EQ(gaussian.points().size(), 1025U);
  const double bound = 8 / (0.05 * 0.05) / (1024.0 * 1024.0) / 8;
  for (double s = 0; s <= 1; s += 1.0 / 3001)
    EXPECT_NEAR(extinction_at(gaussian, s), 8 * std::exp(-(s - 0.5) * (s - 0.5) / 0.005), bound * (1 + 1e-9));
  EXPECT_EQ(extinction_at(gaussian, 0.5), 8);
}

TEST(StudyTransfers, RandomEntriesDependOnTheSeedAlone) {
  const auto points = random_transfer(8, 1).points();
  ASSERT_EQ(points.size(), 256U);
  std::set<double> numbers;
  double mean = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].s, static_cast<double>(i) / 255);
    EXPECT_EQ(points[i].optics.extinction, random_transfer(8, 1).points()[i].optics.extinction);
    mean += points[i].optics.extinction / 256;
    numbers.insert({points[i].optics.extinction / 8, points[i].optics.color[0], points[i].optics.color[1],
                    points[i].optics.color[2]});
  }
  EXPECT_EQ(numbers.size(), 4U * 256U);
  EXPECT_NEAR(mean, 4, 5 * 8 / std::sqrt(12 * 256));  // five deviations of the mean
  EXPECT_NE(points[0].optics.extinction, random_transfer(8, 2).points()[0].optics.extinction);
}

TEST(StudyTransfers, ChannelsOfTheCatalogueDiffer) {
  for (const auto& transfer : catalogue::transfers) {
    if (transfer.make == nullptr) continue;
    const auto points = transfer.make(8, 1).points();
    EXPECT_EQ(points.front().s, 0) << transfer.name;
    EXPECT_EQ(points.back().s, 1) << transfer.name;
    EXPECT_TRUE(std::any_of(points.begin(), points.end(), [](const TransferPoint& point) {
      const auto& color = point.optics.color;
      return color[0] != color[1] && color[1] != color[2] && color[0] != color[2];
    })) << transfer.name;
  }
}

}  // namespace
}  // namespace raytruth
