#include "raytruth/gl/table_builds.hpp"

#include "raytruth/core/real.hpp"
#include "raytruth/gl/texture_look_ups.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/look_up.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"
#include "unit/gl/on_every_gl.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace raytruth {
namespace {

class TableBuilds : public OnEveryGl {};
INSTANTIATE_TEST_SUITE_P(Gl, TableBuilds, every_gl_platform, platform_name);

constexpr std::array both_emissions{Emission::associated, Emission::plain};

// Up to 48 composites, each of which rounds by a few units in the last place of 1, in either arithmetic.
constexpr double composites_rounding = 48 * 4 * 0x1p-24;

TEST_P(TableBuilds, EntriesOneByOneAreThoseOfTheCpu) {
  const TableAxes axes{.size = 48, .low = 0, .high = 1, .length = 1};
  for (const Emission emission : both_emissions) {
    const DiscreteTransfer transfer = sampled(random_transfer(4, 1), axes, emission);
    const Table<float> found = brute_force_table_in_shader(*device, transfer, axes);
    const Table<double> expected = brute_force_table<double>(transfer, axes);
    for (std::size_t i = 0; i < found.values.size(); ++i)
      ASSERT_NEAR(static_cast<double>(found.values[i]), expected.values[i], composites_rounding) << i;
  }
}

TEST_P(TableBuilds, SecondOrderEntriesAreThoseOfTheCpu) {
  const TableAxes axes{.size = 16, .low = 0, .high = 1, .length = 1};
  // The studies' function at the entries, which is what the shader knows of it.
  const PiecewiseLinear random = random_transfer(4, 1);
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < axes.size; ++i) points.push_back({axes.scalar(i), random.at(axes.scalar(i))});
  const PiecewiseLinear transfer(std::move(points));
  for (const Emission emission : both_emissions)
    for (const bool is_left : {false, true}) {
      const Iterations iterations{.count = 48, .is_left = is_left};
      const Table3<float> found = second_order_table_in_shader(*device, transfer, axes, emission, iterations);
      SecondOrderSlabs slabs(transfer, axes, emission);
      for (std::size_t back = 0; back < axes.size; ++back)
        for (std::size_t middle = 0; middle < axes.size; ++middle)
          for (std::size_t front = 0; front < axes.size; ++front) {
            const auto expected = slabs({axes.scalar(front), axes.scalar(middle), axes.scalar(back)}, iterations);
            ASSERT_LE((found.at(front, middle, back).cast<double>() - expected).abs().maxCoeff(), composites_rounding)
                << front << ' ' << middle << ' ' << back;
          }
    }
}

// What the table of a file is in a shader: a texture read at texel centres.
TEST_P(TableBuilds, AShaderLooksTablesUpAsTheCpuDoes) {
  const TableAxes axes{.size = 32, .low = 0, .high = 1, .length = 1};
  const Table<float> table = rounded(exact_table(gaussian_transfer(10), axes, Emission::associated));
  const Texture texture{.size = {32, 32, 1}, .dimensions = 2, .channels = 4, .texels = table.values};
  std::vector<float> coordinates;
  std::vector<std::array<Binary32, 2>> scalars;
  for (int i = 0; i < 500; ++i) {
    scalars.push_back({Binary32(0.5 + 0.5 * std::sin(i)), Binary32(0.5 + 0.5 * std::cos(3 * i))});
    for (const Binary32 scalar : scalars.back())
      coordinates.push_back(static_cast<float>(to_double(Rules<Binary32>{}.table_coordinate(scalar, Binary32(32)))));
  }
  const auto found =
      look_up_in_shader(*device, texture, TexelFormat::rgba32f, coordinates, {.is_emulated = true, .weight_bits = 0});
  for (std::size_t i = 0; i < scalars.size(); ++i) {
    const auto expected = bilinear<Binary32>(
        axes,
        [&](std::size_t front, std::size_t back) -> Rules<Binary32>::vec4 {
          return table.at(front, back).cast<double>().cast<Binary32>();
        },
        scalars[i]);
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_NEAR(static_cast<double>(found[4 * i + c]), to_double(expected[static_cast<Eigen::Index>(c)]), 0x1p-22);
  }
}

}  // namespace
}  // namespace raytruth
