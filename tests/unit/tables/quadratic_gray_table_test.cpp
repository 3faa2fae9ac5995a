#include "raytruth/tables/quadratic_gray_table.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/tables/fast_quadratic_gray.hpp"
#include "raytruth/tables/look_up_error.hpp"
#include "raytruth/tables/second_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace raytruth {
namespace {

using Vec4 = Rules<double>::vec4;

constexpr std::array both{Emission::associated, Emission::plain};
constexpr TableAxes small{.size = 33, .low = -1, .high = 3, .length = 1.5};

PiecewiseLinear random_transfer(const TableAxes& axes, double scale) {
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < axes.size; ++i) {
    const auto random = random_numbers(5, RandomStream::points, i);
    points.push_back({axes.scalar(i), {scale * random[0], {random[1], random[2], random[3]}}});
  }
  return PiecewiseLinear(points);
}

double largest_difference(const QuadraticGrayTable<float>& table, const QuadraticGrayTable<double>& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < table.values.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(table.values[i]) - truth.values[i]));
  return largest;
}

TEST(QuadraticGrayTable, IsFilledByEveryKernelAsCertified) {
  // From nearly flat to steep, so that slabs leave the data far behind, from faint to opaque within an interval.
  const RadiusAxis radius{.low = 0x1p-6, .high = 8, .count = 4};
  for (const double scale : {1e-6, 0.3, 4.0, 200.0})
    for (const Emission emission : both) {
      const PiecewiseLinear transfer = random_transfer(small, scale);
      const CertifiedQuadraticGray certified = certified_quadratic_gray_table(transfer, small, radius, emission);
      EXPECT_LE(certified.radius, 1e-11);
      for (const SlabKernels* const kernels : slab_kernel_versions()) {
        QuadraticGrayTable<float> table(small, radius);
        fill_quadratic_gray_table(table, transfer, emission, *kernels);
        EXPECT_LE(largest_difference(table, certified.table), 1e-5) << scale;
        const std::vector<float> opacities = quadratic_gray_opacities(small, radius, transfer, *kernels);
        ASSERT_EQ(4 * opacities.size(), table.values.size());
        for (std::size_t i = 0; i < opacities.size(); ++i)
          ASSERT_NEAR(opacities[i], certified.table.values[4 * i + 3], 1e-5);
      }
    }
}

TEST(QuadraticGrayTable, IsCertifiedWherePointsAreBetweenEntries) {
  const PiecewiseLinear transfer({{-1, {0, {1, 0, 0}}}, {0.777, {2, {0, 1, 1}}}, {3, {0.1, {1, 1, 1}}}});
  const RadiusAxis radius{.low = 0.25, .high = 4, .count = 2};
  const TableAxes axes{.size = 9, .low = -1, .high = 3, .length = 1};
  const auto certified = certified_quadratic_gray_table(transfer, axes, radius, Emission::associated);
  EXPECT_LE(largest_difference(quadratic_gray_table(transfer, axes, radius, Emission::associated), certified.table),
            1e-7);
}

TEST(QuadraticGrayTable, GivesItsEntriesAtTheirNodes) {
  const PiecewiseLinear transfer = random_transfer(small, 1);
  const RadiusAxis radius{.low = 0.25, .high = 4, .count = 3};
  const auto certified = certified_quadratic_gray_table(transfer, small, radius, Emission::associated);
  const QuadraticGrayLookUp<double> look_up(certified.table);
  SecondOrderSlabs slabs(transfer, small, Emission::associated);
  Rules<double> rules;
  for (std::size_t node = 0; node < radius.node_count(); ++node)
    for (std::size_t i = 0; i < 33; i += 4) {
      const std::size_t j = (7 * i + 5) % 33;
      const double middle =
          rules.quadratic_gray_middle(small.scalar(i), small.scalar(j), certified.table.curvature(node), small.length);
      const Vec4 truth = slabs.certified({small.scalar(i), middle, small.scalar(j)}).rgba();
      const std::array scalars{small.scalar(i), middle, small.scalar(j)};
      EXPECT_LE((look_up(scalars) - truth).abs().maxCoeff(), 1e-9) << node;
      EXPECT_LE((look_up(scalars, true) - truth).abs().maxCoeff(), 1e-9) << node;
    }
}

TEST(QuadraticGrayTable, LookUpsConvergeWithTheTable) {
  // A smooth transfer function: halving every distance divides the error by four.
  const PiecewiseLinear transfer({{0, {0, {1, 0, 0}}}, {1, {3, {0, 1, 1}}}});
  double before = 0;
  for (const std::size_t count : {4U, 8U, 16U}) {
    const TableAxes axes{.size = 4 * count + 1, .low = 0, .high = 1, .length = 1};
    const RadiusAxis radius{.low = 0.0625, .high = 0.5, .count = count};
    const auto certified = certified_quadratic_gray_table(transfer, axes, radius, Emission::associated);
    const LookUpError error =
        quadratic_gray_look_up_error(certified.table, transfer, axes, Emission::associated, table_formats[0]);
    if (before > 0) {
      EXPECT_LT(error.root_mean_square, before / 2.8) << count;
    }
    before = error.root_mean_square;
  }
}

TEST(QuadraticGrayPrintedTable, HasEveryStepthGrayValue) {
  const TableAxes axes{.size = 32, .low = 0, .high = 1, .length = 1};
  const PiecewiseLinear transfer({{0, {0, {1, 0.5, 0}}}, {1, {2, {1, 1, 1}}}});
  const auto table = quadratic_gray_printed_table(transfer, axes, printed_radius_axis(), Emission::associated);
  EXPECT_NEAR(table.axes.high, 248.0 / 255, 1e-15);
  EXPECT_EQ(table.values.size(), 4U * 8 * 32 * 32);
  QuadraticGrayPrinted printed(transfer, 0, 1, 1, Emission::associated);
  for (const std::size_t node : {0U, 1U, 7U}) {
    const Vec4 entry = printed.entry(8 * 3, 8 * 20, printed_radius_axis().curvature(node));
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_EQ(table.texel(node, 3, 20)[c], static_cast<float>(entry[static_cast<Eigen::Index>(c)]));
  }
  EXPECT_THROW(quadratic_gray_printed_table(transfer, {.size = 33, .low = 0, .high = 1, .length = 1},
                                            printed_radius_axis(), Emission::associated),
               InputError);
}

TEST(QuadraticGrayTable, RefusesTablesThatAreTooLarge) {
  EXPECT_THROW(QuadraticGrayTable<float>({.size = 1024, .low = 0, .high = 1, .length = 1}, {.count = 100}), InputError);
  EXPECT_THROW(QuadraticGrayTable<float>({.size = 1, .low = 0, .high = 1, .length = 1}, {}), InputError);
}

}  // namespace
}  // namespace raytruth
