#include "raytruth/volume/gradient.hpp"

#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/tricubic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace raytruth {
namespace {

Grid grid_of(std::int64_t size, const std::function<double(double, double, double)>& field) {
  Grid grid{.size = {size, size, size}, .spacing = {1, 1, 1}, .values = {}};
  for (std::int64_t k = 0; k < size; ++k)
    for (std::int64_t j = 0; j < size; ++j)
      for (std::int64_t i = 0; i < size; ++i)
        grid.values.push_back(field(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
  return grid;
}

const GradientFilter& filter_of(std::string_view name) {
  for (const GradientFilter& filter : catalogue::gradient_filters())
    if (filter.name == name) return filter;
  throw std::logic_error(std::string(name));
}

void expect_near(const Vector3<double>& found, const Vector3<double>& expected, double tolerance,
                 std::string_view name) {
  EXPECT_LE((found - expected).matrix().norm(), tolerance) << name << ": " << found.transpose();
}

TEST(Gradient, OfALinearFieldIsItsSlope) {
  const Vector3<double> slope(0.5, -1, 2);
  const Grid grid =
      grid_of(12, [&](double x, double y, double z) { return slope[0] * x + slope[1] * y + slope[2] * z; });
  for (const GradientFilter& filter : catalogue::gradient_filters()) {
    const Gradient gradient = gradient_at(grid, filter, {5.3, 6.1, 5.9});
    expect_near(gradient.raw, slope, 1e-13, filter.name);
    expect_near(gradient.normal, slope / slope.matrix().norm(), 1e-14, filter.name);
  }
}

TEST(Gradient, AveragesOverTheOtherAxesByItsWeights) {
  // x (1 + y^2): the central difference is 1 + y^2; means with weights 1, w, 1 add the second moment 2 / (2 + w).
  const Grid grid = grid_of(8, [](double x, double y, double) { return x * (1 + (y - 3) * (y - 3)); });
  EXPECT_DOUBLE_EQ(voxel_gradient(grid, filter_of("central_difference"), 4, 3, 4)[0], 1);
  EXPECT_DOUBLE_EQ(voxel_gradient(grid, filter_of("sobel"), 4, 3, 4)[0], 1.5);
  EXPECT_DOUBLE_EQ(voxel_gradient(grid, filter_of("cubic_b_spline"), 4, 3, 4)[0], 4.0 / 3);
}

TEST(Gradient, OfTheBSplineIsTheSlopeOfTheTricubicSignal) {
  const Grid grid = random_field(16, 0, 3);
  for (std::int64_t axis = 0; axis < 3; ++axis) {
    Ray ray{.origin = {6, 7, 8}, .direction = {0, 0, 0}, .length = 1};
    ray.direction[static_cast<std::size_t>(axis)] = 1;
    Chain<9> signal;
    trace_tricubic(grid, CubicKernel::bspline, ray, signal);
    const Piece<9>& first = signal.pieces.front();
    EXPECT_NEAR(voxel_gradient(grid, filter_of("cubic_b_spline"), 6, 7, 8)[axis],
                first.polynomial.derivative().value(0) / first.length, 1e-12);
  }
}

TEST(Gradient, BeyondTheGridTheFieldIsThatOfItsBorder) {
  const Grid grid = grid_of(4, [](double x, double, double) { return x; });
  EXPECT_DOUBLE_EQ(voxel_gradient(grid, filter_of("central_difference"), 0, 1, 1)[0], 0.5);
  EXPECT_DOUBLE_EQ(voxel_gradient(grid, filter_of("sobel"), 3, 3, 3)[0], 0.5);
  const Grid flat{.size = {3, 1, 1}, .spacing = {1, 1, 1}, .values = {0, 1, 2}};
  expect_near(gradient_at(flat, filter_of("sobel"), {1, 0, 0}).normal, {1, 0, 0}, 1e-15, "flat");
}

TEST(Gradient, NormalsAreUnitVectorsOrZero) {
  const Grid noise = random_field(8, 0, 5);
  const Grid constant = grid_of(6, [](double, double, double) { return 1.0; });
  for (const GradientFilter& filter : catalogue::gradient_filters()) {
    EXPECT_NEAR(gradient_at(noise, filter, {3.2, 4.7, 2.1}).normal.matrix().norm(), 1, 1e-15) << filter.name;
    EXPECT_EQ(gradient_at(constant, filter, {2.5, 2, 2}).normal.matrix().norm(), 0) << filter.name;
  }
}

TEST(Gradient, BetweenVoxelsUnitVectorsAreInterpolated) {
  const Grid noise = random_field(8, 0, 5);
  for (const GradientFilter& filter : catalogue::gradient_filters()) {
    const Vector3<double> mean =
        0.25 * voxel_normal(noise, filter, 3, 4, 2) + 0.75 * voxel_normal(noise, filter, 4, 4, 2);
    expect_near(gradient_at(noise, filter, {3.75, 4, 2}).normal, mean / mean.matrix().norm(), 1e-14, filter.name);
  }
}

TEST(Gradient, ExaggerationTurnsAwayFromTheMean) {
  // A ramp in x with a ripple in y: the mean normal is nearly x, so the tilt towards y grows by about as much again.
  const Grid grid =
      grid_of(16, [](double x, double y, double) { return x + 0.05 * std::sin(2 * std::acos(-1.0) * y / 5); });
  const Vector3<double> plain = voxel_normal(grid, filter_of("central_difference"), 8, 5, 8);
  const Vector3<double> exaggerated = voxel_normal(grid, filter_of("exaggerated"), 8, 5, 8);
  EXPECT_GT(plain[1], 0.01);
  // Over five voxels, its period, the ripple's slope has no mean: N_m = (m, 0, 0), N' = 2 N - N_m.
  const double mean = (2 * plain - exaggerated * ((2 * plain[1]) / exaggerated[1]))[0];
  EXPECT_NEAR(exaggerated[1] / exaggerated[0], 2 * plain[1] / (2 * plain[0] - mean), 1e-12);
  EXPECT_NEAR(mean, 1, 0.002);
  EXPECT_NEAR(exaggerated[2], 0, 1e-15);
}

}  // namespace
}  // namespace raytruth
