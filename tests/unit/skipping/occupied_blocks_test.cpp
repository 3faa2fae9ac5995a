#include "raytruth/skipping/occupied_blocks.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/transfer/emission.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

namespace raytruth {
namespace {

ClearScalars clear_up_to(double s) {
  return {PiecewiseLinear({{s, {0, {1, 1, 1}}}, {s + 1, {1, {1, 1, 1}}}}), Emission::associated};
}

/// 9 x 5 x 3 voxels of 0, with one of another value.
Grid grid_with(double value, std::int64_t i, std::int64_t j, std::int64_t k) {
  Grid grid{.size = {9, 5, 3}, .spacing = {1, 1, 1}, .values = std::vector<double>(135)};
  grid.values[grid.index(i, j, k)] = value;
  return grid;
}

TEST(OccupiedBlocks, ShareLayersOfVoxels) {
  // Blocks of 4: cells 0-4 and 4-8 along x, so voxel 4 belongs to both.
  const OccupiedBlocks blocks(grid_with(1, 4, 0, 0), clear_up_to(0.5), 4, {});
  EXPECT_EQ(blocks.count(), (std::array<std::int64_t, 3>{2, 1, 1}));
  EXPECT_EQ(blocks.share(), 1);
  const OccupiedBlocks one(grid_with(1, 5, 0, 0), clear_up_to(0.5), 4, {});
  EXPECT_FALSE(one.is_occupied(0, 0, 0));
  EXPECT_TRUE(one.is_occupied(1, 0, 0));
}

TEST(OccupiedBlocks, RefinementsWidenTheRange) {
  const Grid grid = grid_with(0.8, 5, 0, 0);
  EXPECT_EQ(OccupiedBlocks(grid, clear_up_to(0.85), 4, {}).share(), 0);
  EXPECT_EQ(OccupiedBlocks(grid, clear_up_to(0.85), 4, {.overshoot = 0.125}).share(), 0.5);  // 0.8 + 0.1
  EXPECT_EQ(OccupiedBlocks(grid, clear_up_to(0.95), 4, {.overshoot = 0.125}).share(), 0);
  EXPECT_EQ(OccupiedBlocks(grid, clear_up_to(0.5), 4, {.growth = 1}).share(), 1);
  EXPECT_EQ(OccupiedBlocks(grid, clear_up_to(0.85), 4, {.margin = 0.1}).share(), 0.5);
  EXPECT_THROW(OccupiedBlocks(grid, clear_up_to(0.5), 0, {}), InputError);
}

TEST(OccupiedBlocks, PartsOfARayAlongAnAxis) {
  const OccupiedBlocks blocks(grid_with(1, 6, 2, 1), clear_up_to(0.5), 4, {});
  std::vector<RayPart> parts;
  blocks.parts({-0.5, 2, 1}, {1, 0, 0}, 9, parts);
  ASSERT_EQ(parts.size(), 1);
  EXPECT_NEAR(parts[0].begin, 4.5, 2e-6);
  EXPECT_EQ(parts[0].end, 9);
  blocks.parts({8.5, 2, 1}, {-1, 0, 0}, 9, parts);
  ASSERT_EQ(parts.size(), 1);
  EXPECT_EQ(parts[0].begin, 0);
  EXPECT_NEAR(parts[0].end, 4.5, 2e-6);
}

TEST(OccupiedBlocks, NothingOutsideTheirPartsIsVisible) {
  const Grid grid = random_field(24, 2, 3);
  const ClearScalars clear = clear_up_to(0.7);
  const OccupiedBlocks blocks(grid, clear, 3, {});
  EXPECT_LT(blocks.share(), 0.9);
  std::vector<RayPart> parts;
  std::size_t hidden = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Ray ray = random_ray(grid, 12, 5, i);
    ray.direction = unit_direction(ray.direction);
    ray.length = 12;
    blocks.parts(ray.origin, ray.direction, ray.length, parts);
    const Omissions omissions{.occupied = parts};
    for (const auto& piece : trace_trilinear(grid, ray).pieces) {
      const auto start = static_cast<double>(piece.start);
      if (!omissions.omit(start, start + piece.length)) continue;
      ++hidden;
      const auto [low, high] = piece.polynomial.range();
      EXPECT_TRUE(clear.contain(low, high - 1e-12)) << i;
    }
  }
  EXPECT_GT(hidden, 300);
}

}  // namespace
}  // namespace raytruth
