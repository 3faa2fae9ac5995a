#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/schemes/slab_integrals.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/interval_slabs.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>

// Tables and schemes for transfer functions that are linear in opacity.
namespace raytruth {
namespace {

const Vector3<double> red{1, 0.25, 0};
const Vector3<double> blue{0, 0.5, 1};

/// Up to 0.99, through a single scalar of opacity 1, and with a jump.
const PiecewiseLinear smooth = from_opacity({{0, 0.1, red}, {0.37, 0.99, blue}, {1, 0.2, red}}, 0.5);
const PiecewiseLinear touching = from_opacity({{0, 0, red}, {0.37, 1, blue}, {0.8, 0.3, red}, {0.8, 0.6, blue}}, 2);

TEST(ExactTable, IsTheReferenceWhereOpacityIsLinear) {
  const TableAxes axes{.size = 17, .low = 0, .high = 1, .length = 1.5};
  for (const PiecewiseLinear& transfer : {smooth, touching})
    for (const Emission emission : both_emissions) {
      const Table<double> table = exact_table(transfer, axes, emission);
      RayIntegral integral(transfer, emission);
      for (std::size_t front = 0; front < axes.size; front += 4)
        for (std::size_t back = 0; back < axes.size; back += 2) {
          const double begin = axes.scalar(front);
          const double end = axes.scalar(back);
          const Certified truth =
              integral(piecewise_polynomial({0, axes.length}, {{begin, (end - begin) / axes.length}}));
          const auto found = table.at(front, back);
          for (Eigen::Index i = 0; i < 4; ++i)
            EXPECT_NEAR(found[i], truth.rgba()[i], truth.radius + 1e-12) << front << ", " << back;
        }
    }
}

TEST(IntervalSlabs, EndWhereTheOpacityIsOneOnAStretch) {
  const PiecewiseLinear wall = from_opacity({{0, 0, red}, {0.5, 1, blue}, {1, 1, red}}, 1);
  const TableAxes axes{.size = 3, .low = 0, .high = 1, .length = 1};
  const auto slabs = IntervalSlabs(wall, axes, Emission::associated)(1, false);
  EXPECT_NEAR(slabs[0][3], 1 - std::exp(-1), 1e-13);
  EXPECT_EQ(slabs[1][3], 1);
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(slabs[1][i], blue[i], 1e-14);
}

TEST(OpticsIntegral, OfLinearOpacityIsTheMeanLogarithm) {
  // From 0 to 1 along a unit: the mean of -ln(1 - a) is 1, and that of -x ln(1 - x) is 3/4.
  const PiecewiseLinear whole = from_opacity({{0, 0, red}, {1, 1, blue}}, 1);
  const std::array slab{Piece<3>{0.0, 1, Bernstein<1>{{0, 1}}.elevated<3>()}};
  const auto integral = optics_integral(slab, whole, Emission::associated);
  EXPECT_NEAR(integral[3], 1, 1e-10);
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(integral[i], 0.25 * red[i] + 0.75 * blue[i], 1e-10);
}

}  // namespace
}  // namespace raytruth
