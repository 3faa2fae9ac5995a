#include "raytruth/signals/point_gradient.hpp"

#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/tricubic_value.hpp"
#include "raytruth/signals/trilinear_value.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace raytruth {
namespace {

using Place = std::array<double, 3>;

Grid grid_of(const std::function<double(double x, double y, double z)>& f) {
  Grid grid{.size = {9, 8, 10}, .spacing = {1, 1.5, 0.5}, .values = {}};
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 9; ++i) grid.values.push_back(f(i, j, k));
  return grid;
}

double difference(const Vector3<double>& a, const Vector3<double>& b) { return (a - b).abs().maxCoeff(); }

TEST(PointGradient, OfACubicThroughTheBSplineIsWhatTheKernelMakesOfIt) {
  // The B-spline weighs voxels so that x^3 becomes x^3 + x, whose slope is 3 x^2 + 1; central differences over two
  // voxels add the third derivative over 6, 1.
  const Grid grid = grid_of([](double x, double y, double z) { return x * x * x + 2 * y - z; });
  for (const Place& place : {Place{4, 3, 5}, {3.25, 3.5, 4.75}, {4.9, 2.1, 5.3}}) {
    const double slope = 3 * place[0] * place[0] + 1;
    const auto by = [&](GradientKind kind) { return PointGradient(grid, grid, FieldKind::bspline, kind)(place); };
    EXPECT_LT(difference(by(GradientKind::analytic), {slope, 2 / 1.5, -1 / 0.5}), 1e-12);
    EXPECT_LT(difference(by(GradientKind::differences), {slope + 1, 2 / 1.5, -1 / 0.5}), 1e-12);
    // At the voxels x^3 has the difference 3 x^2 + 1, and the line between two of these is above by u (1 - u) 3.
    const double u = place[0] - std::floor(place[0]);
    EXPECT_LT(difference(by(GradientKind::voxels), {slope + 3 * u * (1 - u), 2 / 1.5, -1 / 0.5}), 1e-12);
  }
}

TEST(PointGradient, ByVoxelsIsByDifferencesOfTheTrilinearField) {
  Grid grid = random_field(9, 1.5, 3);
  grid.spacing = {1, 1.5, 1.25};
  for (const Place& place : {Place{4, 3, 5}, {3.25, 2.5, 4.75}, {1.1, 6.9, 5.3}})
    EXPECT_LT(difference(PointGradient(grid)(place),
                         PointGradient(grid, grid, FieldKind::trilinear, GradientKind::differences)(place)),
              1e-14);
}

TEST(PointGradient, IsTheSlopeOfTheReconstruction) {
  Grid grid = random_field(9, 1.5, 3);
  grid.spacing = {1, 1.5, 1.25};
  constexpr double little = 1e-5;
  for (const FieldKind field : {FieldKind::trilinear, FieldKind::bspline, FieldKind::catmull_rom})
    for (const Place& place : {Place{4.3, 3.6, 5.2}, {0.2, 0.3, 7.9}, {-0.3, 8.2, 4.5}}) {
      Vector3<double> slope;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Place low = place;
        Place high = place;
        low[axis] -= little;
        high[axis] += little;
        const auto value = [&](const Place& at) {
          if (field == FieldKind::trilinear) return trilinear_value(grid, at);
          return tricubic_value(grid, field == FieldKind::bspline ? CubicKernel::bspline : CubicKernel::catmull_rom,
                                at);
        };
        slope[static_cast<Eigen::Index>(axis)] = (value(high) - value(low)) / (2 * little) / grid.spacing[axis];
      }
      // Third derivatives of some units times 1e-10, and the rounding of values over 2e-5.
      EXPECT_LT(difference(PointGradient(grid, grid, field, GradientKind::analytic)(place), slope), 1e-9);
    }
}

}  // namespace
}  // namespace raytruth
