#include "raytruth/signals/trilinear.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "unit/support/degenerate_rays.hpp"
#include "unit/support/exact_ray.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace raytruth {
namespace {

using testing_support::degenerate_rays;
using testing_support::exact_chain;
using testing_support::exact_ray;
using testing_support::ExactRay;
using testing_support::in_50_digits;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Units are those of the data range, here 1.
constexpr double few_ulps = 4 * epsilon;

Grid noise(std::array<std::int64_t, 3> size) {
  Grid grid{.size = size, .spacing = {1, 1, 1}, .values = {}};
  const auto count = static_cast<std::size_t>(size[0] * size[1] * size[2]);
  for (std::size_t i = 0; i < count; ++i) grid.values.push_back(random_numbers(5, RandomStream::field, i)[0]);
  return grid;
}

/// Largest deviation from the eight voxels' value in 50 digits, over abscissae inside and at the ends of pieces.
double value_error(const Grid& grid, const Ray& ray, const Chain<3>& chain, std::size_t stride = 1,
                   Border border = Border::half_voxel) {
  const ExactRay exact = exact_ray(grid, ray, border);
  double worst = 0;
  for (std::size_t i = 0; i < chain.pieces.size(); i += stride) {
    const auto& piece = chain.pieces[i];
    for (const double u : {0.0, 0.001, 0.25, 0.5, 0.8, 0.999}) {
      const DoubleDouble t = piece.start + DoubleDouble(u * piece.length);
      const Real50 truth = trilinear_value(grid, exact.point(in_50_digits(t)));
      worst = std::max(worst, std::abs(to_double(Real50(piece.polynomial.value(piece.local(t))) - truth)));
    }
  }
  return worst;
}

void expect_continuous(const Chain<3>& chain) {
  for (std::size_t i = 1; i < chain.pieces.size(); ++i) {
    const auto& before = chain.pieces[i - 1];
    EXPECT_EQ(before.polynomial.coefficients.back(), chain.pieces[i].polynomial.coefficients.front());
    EXPECT_LT(before.start, chain.pieces[i].start);
    EXPECT_NEAR(before.length, static_cast<double>(chain.pieces[i].start - before.start), 2 * epsilon * before.length);
  }
}

/// Everything a chain promises, against the chain made without a walk.
void expect_exact(const Grid& grid, const Ray& ray, Border border = Border::half_voxel) {
  const Chain<3> chain = trace_trilinear(grid, ray, border);
  const Chain<3, Real50> exact = exact_chain(grid, ray, border);
  ASSERT_EQ(chain.pieces.size(), exact.pieces.size());
  EXPECT_NEAR(chain.length(), to_double(exact.end), epsilon * to_double(exact.end));
  EXPECT_LE(value_error(grid, ray, chain, 1, border), few_ulps);
  for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
    const auto& piece = chain.pieces[i];
    EXPECT_LE(abs(in_50_digits(piece.start) - exact.pieces[i].start), ldexp(exact.end, -95));
    EXPECT_NEAR(piece.length, to_double(exact.pieces[i].length), 2 * epsilon * piece.length);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(piece.polynomial.coefficients[k], to_double(exact.pieces[i].polynomial.coefficients[k]), few_ulps);
  }
  expect_continuous(chain);
}

TEST(Trilinear, RandomRaysAreExact) {
  const Grid grid = noise({13, 9, 11});
  for (std::uint64_t i = 0; i < 200; ++i) {
    Ray ray = random_ray(grid, 6, 1, i);
    expect_exact(grid, ray);
    // Now the line comes from outside, and goes through the whole grid.
    for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] -= 30 * ray.direction[axis];
    ray.length = std::numeric_limits<double>::infinity();
    expect_exact(grid, ray);
  }
}

TEST(Trilinear, DegenerateRaysAreExact) {
  const Grid grid = noise({5, 6, 7});
  const std::vector<Ray> rays = degenerate_rays();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SCOPED_TRACE("ray " + std::to_string(i));
    expect_exact(grid, rays[i]);
  }
}

TEST(Trilinear, RaysThatEndAtVoxelCentresAreExact) {
  const Grid box = noise({5, 6, 7});
  const std::vector<Ray> rays = degenerate_rays();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SCOPED_TRACE("degenerate ray " + std::to_string(i));
    expect_exact(box, rays[i], Border::voxel_centres);
  }
  const Grid grid = noise({13, 9, 11});
  for (std::uint64_t i = 0; i < 200; ++i) {
    SCOPED_TRACE("random ray " + std::to_string(i));
    Ray ray = random_ray(grid, 6, 1, i);
    for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] -= 30 * ray.direction[axis];
    ray.length = std::numeric_limits<double>::infinity();
    expect_exact(grid, ray, Border::voxel_centres);
    // Half a voxel less on every side: no piece is in a clamped half.
    const auto centres = exact_ray(grid, ray, Border::voxel_centres);
    for (const Real50& t : {Real50(0), centres.length})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(centres.point(t)[axis], -1e-40);
        EXPECT_LE(centres.point(t)[axis], Real50(grid.size[axis] - 1) + 1e-40);
      }
    EXPECT_LT(trace_trilinear(grid, ray, Border::voxel_centres).length(), trace_trilinear(grid, ray).length());
  }
}

TEST(Trilinear, RowOfVoxelsEndsAtItsCentres) {
  const Grid row{.size = {4, 1, 1}, .spacing = {1, 1, 1}, .values = {0.5, 0.25, 1, 0}};
  const Chain<3> chain =
      trace_trilinear(row, {{-3, 0, 0}, {1, 0, 0}, std::numeric_limits<double>::infinity()}, Border::voxel_centres);
  ASSERT_EQ(chain.pieces.size(), 3);
  EXPECT_EQ(chain.length(), 3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(chain.pieces[i].polynomial.coefficients.front(), row.values[i]);
    EXPECT_EQ(chain.pieces[i].polynomial.coefficients.back(), row.values[i + 1]);
  }
  // Beside its one line of centres there is nothing.
  EXPECT_TRUE(trace_trilinear(row, {{-3, 0, 1e-12}, {1, 0, 0}, 9}, Border::voxel_centres).pieces.empty());
}

TEST(Trilinear, RayThatMissesIsEmpty) {
  const Grid grid = noise({5, 6, 7});
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Ray> rays{
      {{-3, 2, 3}, {-1, 0, 0}, infinity},      // looks away
      {{-3, 7, 3}, {1, 0, 0}, infinity},       // passes by
      {{-3, -0.6, 3}, {1, 0, 0}, infinity},    // passes by closely
      {{4.6, 2, 2}, {0, 1, 0}, infinity},      // beside the field
      {{-1.5, 0.5, 3}, {1, -1, 0}, infinity},  // touches an edge of the field
      {{2, 2, 2}, {1, 0, 0}, 0},               // length zero
      {{4.5, 2, 2}, {1, 0, 0}, infinity},      // starts where the field ends
  };
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SCOPED_TRACE("ray " + std::to_string(i));
    const Chain<3> chain = trace_trilinear(grid, rays[i]);
    EXPECT_TRUE(chain.pieces.empty());
    EXPECT_EQ(chain.length(), 0);
  }
}

TEST(Trilinear, FlatGridsAndSingleVoxels) {
  expect_exact(noise({1, 1, 1}), {{-2, 0.1, 0.2}, {1, 0.05, 0.1}});
  expect_exact(noise({1, 8, 1}), {{0.2, -2, 0.1}, {0.01, 1, 0.02}});
  expect_exact(noise({9, 1, 4}), {{-1, 0.3, -1}, {1, -0.05, 0.4}});
}

TEST(Trilinear, AMillionCellsLongIsStillExact) {
  const Grid grid = noise({1'000'003, 2, 2});
  for (const Ray& ray : {Ray{{-7, -0.4, -0.3}, {1, 1.5e-6, 1.3e-6}}, Ray{{1'000'002.3, 1.2, 0.1}, {-1, -1e-6, 1e-6}}}) {
    const Chain<3> chain = trace_trilinear(grid, ray);
    EXPECT_GE(chain.pieces.size(), 1'000'003U);
    EXPECT_LE(value_error(grid, ray, chain, 997), few_ulps);
    expect_continuous(chain);
  }
}

TEST(Trilinear, ConstantDataGiveConstantSignals) {
  Grid grid = noise({4, 4, 4});
  std::fill(grid.values.begin(), grid.values.end(), 0.1);
  for (std::uint64_t i = 0; i < 50; ++i) EXPECT_TRUE(trace_trilinear(grid, random_ray(grid, 2, 1, i)).is_constant());
}

TEST(Trilinear, LinearDataGiveLinearSignals) {
  Grid grid = noise({6, 6, 6});
  for (std::int64_t k = 0; k < 6; ++k)
    for (std::int64_t j = 0; j < 6; ++j)
      for (std::int64_t i = 0; i < 6; ++i)
        grid.values[grid.index(i, j, k)] =
            0.5 * static_cast<double>(i) - 2.0 * static_cast<double>(j) + static_cast<double>(k);
  const Ray ray{{1, 4, 1}, {1, -1, 1}, 3};
  const Chain<3> chain = trace_trilinear(grid, ray);
  const double slope = (0.5 + 2.0 + 1.0) / std::sqrt(3.0);
  for (const double t : {0.0, 0.3, 1.1, 2.9}) EXPECT_NEAR(chain.value(t), 0.5 - 8 + 1 + slope * t, 1e-14);
}

TEST(Trilinear, KeepsItsMemory) {
  const Grid grid = noise({16, 16, 16});
  Chain<3> chain;
  trace_trilinear(grid, {{-1, -1, -1}, {1, 1, 1.1}}, chain);
  const auto* const memory = chain.pieces.data();
  trace_trilinear(grid, {{-1, 3, 3}, {1, 0.1, 0}}, chain);
  EXPECT_EQ(chain.pieces.data(), memory);
}

TEST(Trilinear, RefusesRaysThatAreNone) {
  const Grid grid = noise({4, 4, 4});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(trace_trilinear(grid, {{1, 1, 1}, {0, 0, 0}}), InputError);
  EXPECT_THROW(trace_trilinear(grid, {{1, 1, 1}, {nan, 0, 1}}), InputError);
  EXPECT_THROW(trace_trilinear(grid, {{1, 1, 1}, {infinity, 0, 1}}), InputError);
  EXPECT_THROW(trace_trilinear(grid, {{nan, 1, 1}, {1, 0, 0}}), InputError);
  EXPECT_THROW(trace_trilinear(grid, {{1e13, 1, 1}, {1, 0, 0}}), InputError);
  EXPECT_THROW(trace_trilinear(grid, {{1, 1, 1}, {1, 0, 0}, -1}), InputError);
  EXPECT_THROW(trace_trilinear(grid, {{1, 1, 1}, {1, 0, 0}, nan}), InputError);
  // Directions need not be unit vectors, whatever their size.
  EXPECT_EQ(trace_trilinear(grid, {{1, 1, 1}, {1e-200, 0, 0}}).length(), 2.5);
  EXPECT_EQ(trace_trilinear(grid, {{1, 1, 1}, {1e200, 0, 0}}).length(), 2.5);
}

}  // namespace
}  // namespace raytruth
