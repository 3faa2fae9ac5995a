#include "raytruth/signals/fields/ct_phantom.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <variant>
#include <vector>

namespace raytruth {
namespace {

double mean(const Grid& grid) {
  return std::accumulate(grid.values.begin(), grid.values.end(), 0.0) / static_cast<double>(grid.values.size());
}

/// The share of voxels of at least this value.
double share(const Grid& grid, double value) {
  const auto count =
      std::count_if(grid.values.begin(), grid.values.end(), [value](double voxel) { return voxel >= value; });
  return static_cast<double>(count) / static_cast<double>(grid.values.size());
}

const CtPhantom sharp{.size = 96, .spread = 0, .noise = 0};

TEST(CtPhantom, HasEightBits) {
  for (const double value : make_grid(CtPhantom{.size = 24}).values) {
    EXPECT_TRUE(value >= 0 && value <= 1);
    EXPECT_EQ(value, std::round(255 * value) / 255);
  }
}

TEST(CtPhantom, LevelsAreThoseOfItsParts) {
  const Grid grid = make_grid(sharp);
  const auto level = [](double value) { return std::round(255 * value) / 255; };
  EXPECT_EQ(grid.at(0, 0, 0), 0);               // air
  EXPECT_EQ(grid.at(48, 48, 48), level(0.45));  // brain
  EXPECT_EQ(grid.at(84, 48, 48), level(0.4));   // skin, between 0.72 and 0.8 along x
  EXPECT_EQ(grid.at(80, 48, 48), level(0.85));  // skull, between 0.65 and 0.72
  EXPECT_EQ(grid.at(63, 38, 48), level(0.65));  // a vessel at x = 0.32, y = -0.2
  EXPECT_EQ(grid.at(44, 17, 37), 0);            // the sinus beside its walls
}

TEST(CtPhantom, VolumesAreThoseOfItsParts) {
  // All that is not air, above the bed, lies in the outer ellipsoid; the walls in the sinus are thin. Of the voxels at
  // its border half is in.
  const Grid grid = make_grid(sharp);
  const auto& skin = std::get<PhantomEllipsoid>(phantom_parts()[0]);
  const auto& sinus = std::get<PhantomEllipsoid>(phantom_parts()[7]);
  const auto volume = [](const PhantomEllipsoid& part) {
    return std::numbers::pi / 6 * part.half[0] * part.half[1] * part.half[2];
  };
  std::int64_t count = 0;
  for (std::int64_t k = 0; k < 96; ++k)
    for (std::int64_t j = 0; j < 91; ++j)
      for (std::int64_t i = 0; i < 96; ++i) count += grid.at(i, j, k) >= 0.2 ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(count) / (96.0 * 96 * 96), volume(skin) - volume(sinus), 0.003);
}

TEST(CtPhantom, SpreadKeepsTheMeanAndBlursWalls) {
  const Grid blurred = make_grid(CtPhantom{.size = 96, .spread = 1.5, .noise = 0});
  const Grid grid = make_grid(sharp);
  EXPECT_NEAR(mean(blurred), mean(grid), 1e-3);
  EXPECT_GT(share(grid, 0.8), 2 * share(blurred, 0.8));  // the skull is 3 voxels thick
}

TEST(CtPhantom, NoiseHasItsDeviation) {
  const Grid noisy = make_grid(CtPhantom{.size = 96, .spread = 0, .noise = 0.02});
  const Grid grid = make_grid(sharp);
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    if (grid.values[i] < 0.3) continue;  // in air noise is cut off at 0
    const double difference = noisy.values[i] - grid.values[i];
    sum += difference;
    squares += difference * difference;
    ++count;
  }
  EXPECT_NEAR(sum / count, 0, 1e-3);
  EXPECT_NEAR(std::sqrt(squares / count), std::sqrt(0.0004 + 1 / (12 * 255.0 * 255)), 3e-4);
}

TEST(CtPhantom, SameBytesOnAnyNumberOfThreadsAndOthersForAnotherSeed) {
  const CtPhantom phantom{.size = 31};
  const Grid grid = make_grid(phantom);
  EXPECT_NE(make_grid(CtPhantom{.size = 31, .seed = 2}).values, grid.values);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(make_grid(phantom).values, grid.values);
}

TEST(CtPhantom, RefusesOptionsOutOfRange) {
  EXPECT_THROW(make_grid(CtPhantom{.size = 1}), FieldOptionError);
  EXPECT_THROW(make_grid(CtPhantom{.spread = -1}), FieldOptionError);
  EXPECT_THROW(make_grid(CtPhantom{.noise = 2}), FieldOptionError);
}

}  // namespace
}  // namespace raytruth
