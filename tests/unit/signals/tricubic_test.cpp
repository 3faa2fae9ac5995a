#include "raytruth/signals/tricubic.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/tricubic_value.hpp"
#include "unit/support/exact_ray.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace raytruth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr std::array kernels{CubicKernel::bspline, CubicKernel::catmull_rom};

double sine(double x) { return std::sin(0.7 * x + 0.3); }

TEST(Tricubic, EveryPieceAgreesWith64VoxelsIn50Digits) {
  const Grid grid = random_field(12, 0, 6);
  for (const CubicKernel kernel : kernels) {
    double worst = 0;
    for (std::uint64_t i = 0; i < 60; ++i) {
      Ray ray = random_ray(grid, 6, 1, i);
      // Every third ray from outside, through the clamped borders.
      if (i % 3 == 0) {
        for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] -= 20 * ray.direction[axis];
        ray.length = std::numeric_limits<double>::infinity();
      }
      Chain<9> chain;
      trace_tricubic(grid, kernel, ray, chain);
      const auto exact = testing_support::exact_ray(grid, ray);
      for (const auto& piece : chain.pieces)
        for (const double u : {0.0, 0.3, 0.5, 0.99}) {
          const DoubleDouble t = piece.start + DoubleDouble(u * piece.length);
          const Real50 truth = tricubic_value(grid, kernel, exact.point(testing_support::in_50_digits(t)));
          worst = std::max(worst, std::abs(to_double(Real50(piece.polynomial.value(piece.local(t))) - truth)));
        }
    }
    // The bound is in units of the data range, here 1.
    EXPECT_LE(worst, 8 * epsilon);
  }
}

TEST(Tricubic, CellsAreThoseOfTheTrilinearChain) {
  const Grid grid = random_field(12, 0, 6);
  const Ray ray{{-3, 2.2, 3.3}, {1, 0.3, 0.4}};
  Chain<9> cubic;
  trace_tricubic(grid, CubicKernel::bspline, ray, cubic);
  const Chain<3> linear = trace_trilinear(grid, ray);
  ASSERT_EQ(cubic.pieces.size(), linear.pieces.size());
  for (std::size_t i = 0; i < cubic.pieces.size(); ++i) EXPECT_EQ(cubic.pieces[i].start, linear.pieces[i].start);
  EXPECT_EQ(cubic.end, linear.end);
}

TEST(Tricubic, SmoothnessAcrossCells) {
  // B-splines are C2, Catmull-Rom is C1: derivatives along the ray, times the piece's length to each power.
  const Grid grid = random_field(12, 0, 6);
  Chain<9> chain;
  for (const CubicKernel kernel : kernels) {
    trace_tricubic(grid, kernel, {{-3, 2.2, 3.3}, {1, 0.3, 0.4}}, chain);
    double slope_jump = 0;
    double curvature_jump = 0;
    for (std::size_t i = 1; i < chain.pieces.size(); ++i) {
      const auto& a = chain.pieces[i - 1];
      const auto& b = chain.pieces[i];
      const double shorter = std::min(a.length, b.length);
      EXPECT_NEAR(a.polynomial.value(1), b.polynomial.value(0), 8 * epsilon);
      const auto slope = [](const auto& p, double u) { return p.polynomial.derivative().value(u) / p.length; };
      const auto curvature = [](const auto& p, double u) {
        return p.polynomial.derivative().derivative().value(u) / (p.length * p.length);
      };
      slope_jump = std::max(slope_jump, std::abs(slope(a, 1) - slope(b, 0)) * shorter);
      curvature_jump = std::max(curvature_jump, std::abs(curvature(a, 1) - curvature(b, 0)) * shorter * shorter);
    }
    EXPECT_LE(slope_jump, 1e-13);
    if (kernel == CubicKernel::bspline)
      EXPECT_LE(curvature_jump, 1e-12);
    else
      EXPECT_GE(curvature_jump, 1e-3);
  }
}

TEST(Tricubic, CatmullRomPassesThroughItsVoxels) {
  const Grid grid = random_field(8, 0, 2);
  for (std::int64_t i = 0; i < 8; ++i)
    EXPECT_NEAR(tricubic_value<double>(grid, CubicKernel::catmull_rom, {static_cast<double>(i), 3, 5}),
                grid.at(i, 3, 5), epsilon);
}

TEST(Prefilter, SplineReproducesTheVoxels) {
  for (const std::array<std::int64_t, 3>& size : std::vector<std::array<std::int64_t, 3>>{{9, 7, 8}, {1, 2, 3}}) {
    Grid grid{.size = size, .spacing = {1, 1, 1}, .values = {}};
    for (std::int64_t i = 0; i < size[0] * size[1] * size[2]; ++i)
      grid.values.push_back(sine(static_cast<double>(i * i % 17)));
    const Grid coefficients = bspline_coefficients(grid);
    for (std::int64_t k = 0; k < size[2]; ++k)
      for (std::int64_t j = 0; j < size[1]; ++j)
        for (std::int64_t i = 0; i < size[0]; ++i)
          EXPECT_NEAR(tricubic_value<double>(coefficients, CubicKernel::bspline,
                                             {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}),
                      grid.at(i, j, k), 64 * epsilon);
  }
}

TEST(Prefilter, RestoresTheAmplitudeThatTheSplineTakes) {
  // On one line far from its ends, a sine is scaled by (2 + cos w) / 3 by the spline, and so divided by the prefilter.
  Grid grid{.size = {201, 1, 1}, .spacing = {1, 1, 1}, .values = {}};
  for (int i = 0; i < 201; ++i) grid.values.push_back(sine(i));
  const Grid coefficients = bspline_coefficients(grid);
  for (std::int64_t i = 60; i < 140; ++i)
    EXPECT_NEAR(coefficients.at(i, 0, 0), sine(static_cast<double>(i)) * 3 / (2 + std::cos(0.7)), 1e-14);
}

}  // namespace
}  // namespace raytruth
