#include "raytruth/signals/random_field.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Random123/philox.h>

#include <cmath>

namespace raytruth {
namespace {

TEST(RandomNumbers, AreThePublishedGenerator) {
  // Known answer of the authors' test vectors (kat_vectors): philox4x32 10, counter and key all ones.
  const r123::Philox4x32::ctr_type counter{{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}};
  const r123::Philox4x32::key_type key{{0xffffffff, 0xffffffff}};
  const r123::Philox4x32::ctr_type expected{{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}};
  EXPECT_EQ(r123::Philox4x32{}(counter, key), expected);
}

TEST(RandomNumbers, DependOnEveryArgument) {
  const auto base = random_numbers(1, RandomStream::rays, 2, 3);
  EXPECT_EQ(base, random_numbers(1, RandomStream::rays, 2, 3));
  EXPECT_NE(base, random_numbers(2, RandomStream::rays, 2, 3));
  EXPECT_NE(base, random_numbers(1ULL + (1ULL << 32U), RandomStream::rays, 2, 3));
  EXPECT_NE(base, random_numbers(1, RandomStream::points, 2, 3));
  EXPECT_NE(base, random_numbers(1, RandomStream::rays, 2 + (1ULL << 32U), 3));
  EXPECT_NE(base, random_numbers(1, RandomStream::rays, 2, 4));
}

TEST(RandomField, SameBytesOnAnyNumberOfThreads) {
  for (const double smoothing : {0.0, 0.5, 4.0}) {
    const Grid on_all = random_field(32, smoothing, 9);
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(random_field(32, smoothing, 9).values, on_all.values);
  }
}

TEST(RandomField, WhiteNoiseIsUniformAndUncorrelated) {
  const Grid grid = random_field(64, 0, 1);
  const auto count = static_cast<double>(grid.values.size());
  double mean = 0;
  double square = 0;
  double neighbour = 0;
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    const double x = grid.values[i] - 0.5;
    mean += x / count;
    square += x * x / count;
    neighbour += x * (grid.values[(i + 1) % grid.values.size()] - 0.5) / count;
  }
  // Five standard deviations of the means.
  EXPECT_NEAR(mean, 0, 5 * std::sqrt(1 / 12.0 / count));
  EXPECT_NEAR(square, 1 / 12.0, 5 * std::sqrt(1 / 180.0 / count));
  EXPECT_NEAR(neighbour, 0, 5 / 12.0 / std::sqrt(count));
}

TEST(RandomField, SmoothNoiseHasTheCorrelationOfItsKernel) {
  // Noise smoothed by a Gaussian of deviation d has the correlation exp(-k^2 / (4 d^2)) at distance k.
  const double deviation = 2;
  const Grid grid = random_field(64, deviation, 3);
  double mean = 0;
  for (const double value : grid.values) mean += value / static_cast<double>(grid.values.size());
  double square = 0;
  std::array<double, 4> product{};
  for (std::int64_t z = 0; z < 64; ++z)
    for (std::int64_t y = 0; y < 64; ++y)
      for (std::int64_t x = 0; x < 64; ++x) {
        const double here = grid.at(x, y, z) - mean;
        square += here * here;
        // Periodic: the last voxels' neighbours are the first.
        for (std::int64_t k = 1; k <= 3; ++k)
          product[static_cast<std::size_t>(k)] += here * (grid.at((x + k) % 64, y, z) - mean);
      }
  for (std::size_t k = 1; k <= 3; ++k)
    EXPECT_NEAR(product[k] / square, std::exp(-static_cast<double>(k * k) / (4 * deviation * deviation)), 0.02);
}

TEST(RandomField, FillsItsRangeExactly) {
  for (const double smoothing : {0.5, 1.0, 2.0, 4.0}) {
    const auto [low, high] = random_field(32, smoothing, 5).range();
    EXPECT_EQ(low, 0);
    EXPECT_EQ(high, 1);
  }
}

TEST(RandomField, RefusesWhatIsNoField) {
  EXPECT_THROW(random_field(0, 0, 1), InputError);
  EXPECT_THROW(random_field(4096, 0, 1), InputError);
  EXPECT_THROW(random_field(8, -1, 1), InputError);
  EXPECT_THROW(random_field(8, 9, 1), InputError);
  EXPECT_EQ(random_field(1, 0, 1).values.size(), 1U);
}

}  // namespace
}  // namespace raytruth
