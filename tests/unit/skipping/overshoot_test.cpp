#include "raytruth/skipping/overshoot.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/schemes/scheme.hpp"
#include "raytruth/schemes/virtual_catmull_rom.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace raytruth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double bspline_kernel(double x) {
  const double a = std::abs(x);
  if (a < 1) return (4 - 6 * a * a + 3 * a * a * a) / 6;
  return a < 2 ? (2 - a) * (2 - a) * (2 - a) / 6 : 0;
}

TEST(VirtualSample, ExceedsItsSamplesByAnEighthOfTheirRange) {
  EXPECT_NEAR(largest_virtual_sample({0, 1}, {0, 1}), 1.125, 2 * epsilon);
  EXPECT_NEAR(largest_virtual_sample({2, 10}, {2, 10}), 11, 32 * epsilon);
  EXPECT_NEAR(largest_first_virtual_sample({0, 1}), 1.125, 2 * epsilon);
}

TEST(VirtualSample, ExceedsABlockByWhatItsNeighboursHold) {
  EXPECT_NEAR(largest_virtual_sample({0.75, 0.75}, {-1.25, 0.75}), 1, 2 * epsilon);
  EXPECT_NEAR(largest_virtual_sample({0.5, 0.75}, {-1.25, 4}), 1, 2 * epsilon);
}

TEST(VirtualSample, OfRandomSamplesStaysWithinTheBound) {
  Rules<double> rules;
  double largest = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const auto s = random_numbers(7, RandomStream::points, i);
    const auto cubic = Rules<double>::cubic(rules.virtual_catmull_rom(s[0], s[1], s[2], s[3]));
    for (const double u : {0.125, 0.25, 0.5, 0.75}) largest = std::max(largest, cubic.value(u));
  }
  EXPECT_GT(largest, 1.05);
  EXPECT_LE(largest, largest_virtual_sample({0, 1}, {0, 1}));
}

TEST(Overshoot, OfBSplineSamplesIsThatOfOneDimension) {
  // On a ray parallel to an axis; no oblique one found is worse.
  double largest = 0;
  for (int phase = 0; phase < 16; ++phase)
    for (int point = 0; point < 16; ++point) {
      const double p = phase / 16.0;
      const double u = point / 16.0;
      double negative = 0;
      for (int voxel = -4; voxel <= 5; ++voxel) {
        const auto sample = [&](int k) { return bspline_kernel(k + p - voxel); };
        const double weight = 0.5 * (u * u * u * (3 * sample(0) - sample(-1) - 3 * sample(1) + sample(2)) +
                                     u * u * (2 * sample(-1) - 5 * sample(0) + 4 * sample(1) - sample(2)) +
                                     u * (sample(1) - sample(-1)) + 2 * sample(0));
        negative += std::max(-weight, 0.0);
      }
      largest = std::max(largest, negative);
    }
  const Overshoot found = search_overshoot(SampleWeights::bspline, 1, 2000, 1);
  EXPECT_NEAR(found.of_virtual_samples, largest, 1e-15);
  EXPECT_EQ(found.of_true_samples, 0);
}

TEST(Overshoot, OfTrueSamplesIsThatOfTheKernel) {
  const Overshoot catmull_rom = search_overshoot(SampleWeights::catmull_rom, 1, 2000, 1);
  EXPECT_NEAR(catmull_rom.of_true_samples, (std::pow(1.25, 3) - 1) / 2, 1e-15);
  EXPECT_GE(catmull_rom.of_virtual_samples, catmull_rom.of_true_samples);

  // The cardinal spline at the centre of a cell.
  double magnitudes = 0;
  for (int voxel = -40; voxel <= 40; ++voxel) {
    double weight = 0;
    for (int k = -1; k <= 2; ++k)
      weight += bspline_kernel(0.5 - k) * std::sqrt(3.0) * std::pow(std::sqrt(3.0) - 2, std::abs(k - voxel));
    magnitudes += std::abs(weight);
  }
  const Overshoot cardinal = search_overshoot(SampleWeights::cardinal, 1, 500, 1);
  EXPECT_NEAR(cardinal.of_true_samples, (std::pow(magnitudes, 3) - 1) / 2, 2e-4);
}

/// The largest magnitude of virtual samples in a block of zeros, grown, amid voxels of -1 and 1: by tracing rays.
double largest_in_block_of_zeros(BlockRegion region, std::int64_t growth, double step) {
  constexpr std::int64_t size = 24;
  constexpr std::int64_t first = 10;
  constexpr std::int64_t last = 13;
  Grid grid{.size = {size, size, size}, .spacing = {1, 1, 1}, .values = {}};
  for (std::int64_t k = 0; k < size; ++k)
    for (std::int64_t j = 0; j < size; ++j)
      for (std::int64_t i = 0; i < size; ++i) {
        const bool is_inside = std::min({i, j, k}) >= first - growth && std::max({i, j, k}) <= last + growth;
        const auto index = static_cast<std::uint64_t>(i + size * (j + size * k));
        const double sign = random_numbers(3, RandomStream::field, index)[0] < 0.5 ? -1 : 1;
        grid.values.push_back(is_inside ? 0 : sign);
      }
  const double margin = region == BlockRegion::cells ? 0 : 0.5;
  double largest = 0;
  for (std::uint64_t index = 0; index < 400; ++index) {
    const auto at = random_numbers(5, RandomStream::rays, index, 0);
    const auto turn = random_numbers(5, RandomStream::rays, index, 1);
    Ray ray{.origin = {0.5 + at[0], first + 3 * at[1], first + 3 * at[2]}, .direction = {1, 0, 0}};
    if (index % 2 == 1) ray.direction = {1, (turn[0] - 0.5) / 2, (turn[1] - 0.5) / 2};
    const Chain<9> signal = [&] {
      Chain<9> chain;
      trace_tricubic(grid, CubicKernel::bspline, ray, chain);
      return chain;
    }();
    Samples<double> samples;
    sample_constant(signal, step, samples);
    Chain<3> approximation;
    approximate<VirtualCatmullRom>(signal, samples, approximation);
    const auto direction = unit_direction(ray.direction);
    for (int i = 0; i < 64 * approximation.length(); ++i) {
      const double t = i / 64.0;
      bool is_inside = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = ray.origin[axis] + t * direction[axis];
        is_inside = is_inside && x >= first - margin && x <= last + margin;
      }
      if (is_inside) largest = std::max(largest, std::abs(approximation.value(t)));
    }
  }
  return largest;
}

TEST(BlockGrowth, ProvenIsEnoughAndNeededOnTracedRays) {
  for (const auto region : {BlockRegion::cells, BlockRegion::voxels})
    for (const double step : {0.5, 1.0}) {
      const std::int64_t proven = proven_growth(region, step);
      const double below = largest_in_block_of_zeros(region, proven - 1, step);
      EXPECT_LT(largest_in_block_of_zeros(region, proven, step), 1e-15);
      EXPECT_GT(below, 1e-6);
      const BlockLeak found = search_block(region, 4, step, 4000, 1);
      EXPECT_EQ(found.leaking[static_cast<std::size_t>(proven)], 0);
      EXPECT_GT(found.leaking[static_cast<std::size_t>(proven - 1)], 0);
      EXPECT_GE(found.leak[static_cast<std::size_t>(proven - 1)], 0.9 * below);
    }
}

TEST(BlockGrowth, IsThatOfTheErrata) {
  EXPECT_EQ(proven_growth(BlockRegion::cells, 0.5), 2);
  EXPECT_EQ(proven_growth(BlockRegion::cells, 1), 3);
  EXPECT_EQ(proven_growth(BlockRegion::cells, 1.2), 4);
  EXPECT_EQ(proven_growth(BlockRegion::voxels, 1), 4);
}

}  // namespace
}  // namespace raytruth
