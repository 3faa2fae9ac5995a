#include "raytruth/skipping/block_refinement.hpp"

#include "raytruth/schemes/samples.hpp"
#include "raytruth/schemes/virtual_catmull_rom.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <variant>

namespace raytruth {
namespace {

TEST(BlockRefinement, IsWhatItsBoundsSay) {
  for (const FieldKind field : {FieldKind::trilinear, FieldKind::bspline, FieldKind::catmull_rom}) {
    const BlockRefinement unrefined = block_refinement(field, 1, BlockBounds::unrefined);
    EXPECT_EQ(unrefined.growth, 0);
    EXPECT_EQ(unrefined.overshoot, 0);
    const BlockRefinement printed = block_refinement(field, 1, BlockBounds::printed);
    EXPECT_EQ(printed.growth, 0);
    EXPECT_EQ(printed.overshoot, 0.125);
  }
  const BlockRefinement corrected = block_refinement(FieldKind::bspline, 1, BlockBounds::corrected);
  EXPECT_EQ(corrected.growth, 3);  // ceil(2 h) + 1
  EXPECT_EQ(corrected.overshoot, 0.125);
  EXPECT_EQ(block_refinement(FieldKind::trilinear, 0.5, BlockBounds::corrected).growth, 2);
  EXPECT_EQ(block_refinement(FieldKind::trilinear, 2, BlockBounds::corrected).growth, 5);
  // Without a step samples are up to sqrt(3) apart.
  EXPECT_EQ(block_refinement(FieldKind::trilinear, {}, BlockBounds::corrected).growth, 5);
  // Catmull-Rom fields leave the range by f = (1.25^3 - 1)/2 of it on either side, virtual samples by 1/8 of what that
  // makes it, 1 + 2 f.
  EXPECT_EQ(block_refinement(FieldKind::catmull_rom, 1, BlockBounds::corrected).overshoot, 0.4765625 + 1.953125 / 8);
}

TEST(BlockRefinement, MarginsGrowWithValuesAndDisplacements) {
  Grid grid{.size = {2, 1, 1}, .spacing = {1, 1, 1}, .values = {-3, 5}};
  EXPECT_DOUBLE_EQ(margin_of(grid, 0), 8e-7);
  EXPECT_DOUBLE_EQ(margin_of(grid, 1e-9), 8e-7);
  EXPECT_DOUBLE_EQ(margin_of(grid, 1e-6), 8e-4);
  grid.values = {-100, -99};
  EXPECT_DOUBLE_EQ(margin_of(grid, 0), 1e-5);
}

/// How many virtual samples that are not clear lie in blocks that are left out.
std::size_t missed_samples(const Grid& grid, FieldKind kind, double step, BlockBounds bounds) {
  constexpr std::int64_t side = 4;
  const double seen_from = 0.8;
  const ClearScalars clear(PiecewiseLinear({{seen_from, {0, {1, 1, 1}}}, {seen_from + 1, {1, {1, 1, 1}}}}),
                           Emission::associated);
  const auto field = ray_field(grid, kind, Border::half_voxel);
  const OccupiedBlocks blocks(grid, clear, side, block_refinement(kind, step, bounds));
  std::size_t missed = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Ray ray = random_ray(grid, 12, 1, i);
    ray.direction = unit_direction(ray.direction);
    Samples<double> samples;
    std::visit(
        [&]<class Field>(const Field& traced) {
          Chain<Field::degree> chain;
          traced.trace(ray, chain);
          sample_constant(chain, step, samples);
          for (std::size_t k = 0; k + 1 < samples.positions.size(); ++k) {
            const auto curve = VirtualCatmullRom::interval(chain, samples, k);
            for (int part = 1; part < 8; ++part) {
              const double u = part / 8.0;
              if (curve.value(u) <= seen_from) continue;
              const auto begin = static_cast<double>(samples.positions[k]);
              const double t = begin + u * (static_cast<double>(samples.positions[k + 1]) - begin);
              std::array<std::int64_t, 3> block{};
              for (std::size_t axis = 0; axis < 3; ++axis)
                block[axis] = std::clamp(
                    static_cast<std::int64_t>(std::floor((ray.origin[axis] + t * ray.direction[axis]) / side)),
                    std::int64_t{0}, blocks.count()[axis] - 1);
              if (!blocks.is_occupied(block[0], block[1], block[2])) ++missed;
            }
          }
        },
        field);
  }
  return missed;
}

TEST(BlockRefinement, OnlyCorrectedBlocksMissNothing) {
  for (const FieldKind kind : {FieldKind::trilinear, FieldKind::bspline, FieldKind::catmull_rom}) {
    Grid grid = random_field(32, 2, 7);
    for (double& value : grid.values) value = value > 0.62 ? 0.79 : 0.3;  // just clear, until it is overshot
    std::size_t missed = 0;
    for (const double step : {0.75, 1.5}) {
      SCOPED_TRACE(testing::Message() << field_kind_names[static_cast<std::size_t>(kind)] << ", step " << step);
      EXPECT_EQ(missed_samples(grid, kind, step, BlockBounds::corrected), 0U);
      missed += missed_samples(grid, kind, step, BlockBounds::unrefined);
    }
    EXPECT_GT(missed, 0U) << field_kind_names[static_cast<std::size_t>(kind)];
  }
}

}  // namespace
}  // namespace raytruth
