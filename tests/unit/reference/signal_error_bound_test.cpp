// Chains against their signals in 50 digits: at the exactly normalised direction, whatever was rounded on the way.

#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/tricubic.hpp"
#include "raytruth/signals/tricubic_value.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "unit/support/degenerate_rays.hpp"
#include "unit/support/exact_ray.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace raytruth {
namespace {

using testing_support::exactly_directed_ray;
using testing_support::ExactRay;
using testing_support::in_50_digits;

constexpr double infinity = std::numeric_limits<double>::infinity();

// How far the truth is off, for signals of order 1 to 10^6.
constexpr double rounding_of_50_digits = 1e-42;

using Signal = std::function<Real50(const Real50& t)>;

/// p(u) in 50 digits.
template <int Degree>
Real50 value_of(const Bernstein<Degree>& polynomial, const Real50& u) {
  Bernstein<Degree, Real50> exact;
  std::copy(polynomial.coefficients.begin(), polynomial.coefficients.end(), exact.coefficients.begin());
  return exact.value(u);
}

/// What a bound claims, and what was seen of it.
struct Comparison {
  double bound = 0;     ///< the largest
  double observed = 0;  ///< the largest
  std::size_t points = 0;
};

/// Checks the bounds at points of the pieces, their ends included, for both readings of u.
template <int Degree>
Comparison expect_bounds(const Signal& signal, const Chain<Degree>& chain, const SignalError& error,
                         std::size_t stride = 1) {
  EXPECT_EQ(error.of_pieces.size(), chain.pieces.size());
  Comparison comparison;
  for (std::size_t i = 0; i < chain.pieces.size(); i += stride) {
    const auto& piece = chain.pieces[i];
    const double bound = error.of_pieces[i];
    const Real50 start = in_50_digits(piece.start);
    const Real50 length = in_50_digits(chain.end_of(i)) - start;
    // Where constants end, t is not claimed: in all pieces together, and no more is known of any one of them.
    const Real50 unclaimed = bound == 0 ? Real50(error.unclaimed) : Real50(0);
    if (2 * unclaimed >= length && unclaimed > 0) continue;
    for (const double u : {0.0, 1e-15, 0.001, 0.25, 0.5, 0.8, 0.999, 1.0}) {
      const Real50 t = std::min(std::max(start + u * length, start + unclaimed), start + length - unclaimed);
      const Real50 truth = signal(t);
      for (const Real50& reading : {Real50((t - start) / length), Real50((t - start) / piece.length)}) {
        const double difference = to_double(abs(value_of(piece.polynomial, reading) - truth));
        EXPECT_LE(difference, bound + rounding_of_50_digits) << "piece " << i << " at u = " << u;
        comparison.observed = std::max(comparison.observed, difference);
        ++comparison.points;
      }
    }
    comparison.bound = std::max(comparison.bound, bound);
  }
  return comparison;
}

void expect_length(const ExactRay& ray, const DoubleDouble& end, const SignalError& error) {
  const Real50 exact = std::max(ray.length, Real50(0));
  EXPECT_LE(abs(in_50_digits(end) - exact), error.of_length);
}

Comparison expect_trilinear(const Grid& grid, const Ray& ray, std::size_t stride = 1,
                            Border border = Border::half_voxel) {
  const Chain<3> chain = trace_trilinear(grid, ray, border);
  const SignalError error = trilinear_error(grid, ray, chain, {}, {}, border);
  const auto exact = exactly_directed_ray(grid, ray, border);
  expect_length(exact, chain.end, error);
  return expect_bounds([&](const Real50& t) { return trilinear_value(grid, exact.point(t)); }, chain, error, stride);
}

Comparison expect_tricubic(const Grid& grid, CubicKernel kernel, const Ray& ray, Border border = Border::half_voxel) {
  Chain<9> chain;
  trace_tricubic(grid, kernel, ray, chain, border);
  const SignalError error = tricubic_error(grid, kernel, ray, chain, 0, {}, {}, border);
  const auto exact = exactly_directed_ray(grid, ray, border);
  expect_length(exact, chain.end, error);
  return expect_bounds([&](const Real50& t) { return tricubic_value(grid, kernel, exact.point(t)); }, chain, error);
}

/// A ray through the middle of all of the grid, from `distance` of its diagonals away; directions are no unit vectors.
Ray long_ray(const Grid& grid, std::uint64_t index, double distance = 2) {
  const auto u = random_numbers(3, RandomStream::points, index, 0);
  const auto v = random_numbers(3, RandomStream::points, index, 1);
  Ray ray;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto size = static_cast<double>(grid.size[axis]);
    ray.direction[axis] = (2 * u[axis] - 1) * std::exp(8 * u[3] - 4);
    ray.origin[axis] = (0.5 + 0.3 * v[axis]) * (size - 1);
  }
  const double norm = std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
  const double diagonal = std::hypot(grid.size[0], grid.size[1], grid.size[2]);
  for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] -= distance * diagonal * ray.direction[axis] / norm;
  return ray;
}

/// What a direction off by 4 ulps makes of such a ray's way, where voxels differ by up to 1.
double error_of_way(const Grid& grid, double distance = 2) {
  return 4 * std::numeric_limits<double>::epsilon() * (distance + 1) *
         std::hypot(grid.size[0], grid.size[1], grid.size[2]);
}

/// Rays of which the bound is the harder part.
const std::vector<Ray>& hard_rays() {
  static const std::vector<Ray> rays = [] {
    std::vector<Ray> all = testing_support::degenerate_rays();
    all.insert(all.end(),
               {
                   {{2, 2, 2}, {1, -1e-200, 1e-310}, infinity},      // the same along a face of cells
                   {{-3e11, -2e11, -1e11}, {3, 2, 1}, infinity},     // from very far through a corner
                   {{-1e12, 2, 3.25}, {1, 1e-13, 0}, infinity},      // from very far, across a face at a grazing angle
                   {{-3, 7, 3}, {1, 0, 0}, infinity},                // passes by
                   {{-1.5, 0.5, 3}, {1, -1, 0}, infinity},           // touches an edge of the field
                   {{2, 2, 2}, {1e-200, 3e-200, 2e-200}, infinity},  // a small vector
                   {{2, 2, 2}, {1e200, 3e200, 2e200}, infinity},     // a large one
               });
    return all;
  }();
  return rays;
}

/// Two values that white noise chooses between: regions of equal voxels.
Grid labels(std::int64_t size) {
  Grid grid = random_field(size, 1, 4);
  for (double& value : grid.values) value = value < 0.5 ? 0.1 : 0.7;
  return grid;
}

TEST(SignalErrorBound, TrilinearBoundsHoldAndAreTight) {
  const Grid grid = random_field(24, 0, 6);
  for (std::uint64_t i = 0; i < 60; ++i) {
    SCOPED_TRACE("ray " + std::to_string(i));
    const Comparison comparison = expect_trilinear(grid, long_ray(grid, i));
    EXPECT_GE(comparison.points, 100U);
    EXPECT_LE(comparison.bound, error_of_way(grid));
    EXPECT_LE(comparison.bound, 8 * comparison.observed);
  }
}

TEST(SignalErrorBound, TricubicBoundsHoldAndAreTight) {
  const Grid grid = random_field(16, 0, 6);
  for (const CubicKernel kernel : {CubicKernel::bspline, CubicKernel::catmull_rom})
    for (std::uint64_t i = 0; i < 12; ++i) {
      SCOPED_TRACE("ray " + std::to_string(i));
      const Comparison comparison = expect_tricubic(grid, kernel, long_ray(grid, i));
      EXPECT_LE(comparison.bound, 4 * error_of_way(grid));
      EXPECT_LE(comparison.bound, 40 * comparison.observed);
    }
}

TEST(SignalErrorBound, CoversRaysThatAreDisplaced) {
  const Grid noise = random_field(24, 0, 6);
  const Grid two = labels(24);
  std::vector<Ray> rays = hard_rays();
  for (std::uint64_t i = 0; i < 20; ++i) rays.push_back(long_ray(noise, i));
  for (const Grid* const grid : {&noise, &two})
    for (const double size : {1e-13, 1e-6, 0.03, 1.7})
      for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE("ray " + std::to_string(i) + ", displaced by " + std::to_string(size));
        const auto random = random_numbers(5, RandomStream::points, i);
        RayDisplacement displacement;
        std::array<double, 3> sign{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          displacement.at_entry[axis] = random[axis] < 0.2 ? 0 : size * random[axis];
          displacement.per_voxel[axis] = 0.01 * size * (1 - random[axis]);
          sign[axis] = random[(axis + 1) % 3] < 0.5 ? -1 : 1;
        }
        Chain<3> chain;
        trace_trilinear(*grid, rays[i], chain);
        const SignalError error = trilinear_error(*grid, rays[i], chain, {}, displacement);
        const auto exact = exactly_directed_ray(*grid, rays[i]);
        const Signal displaced = [&](const Real50& t) {
          std::array<Real50, 3> point = exact.point(t);
          for (std::size_t axis = 0; axis < 3; ++axis)
            point[axis] += sign[axis] * (displacement.at_entry[axis] + t * displacement.per_voxel[axis]);
          return trilinear_value(*grid, point);
        };
        expect_bounds(displaced, chain, error);
      }
}

TEST(SignalErrorBound, LargeVolumesKeepTheirDigits) {
  const Grid grid = random_field(256, 0, 6);
  std::vector<double> bounds;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Comparison comparison = expect_trilinear(grid, random_ray(grid, 200, 1, i), 29);
    EXPECT_LE(comparison.bound, 8 * comparison.observed);
    bounds.push_back(comparison.bound);
  }
  std::sort(bounds.begin(), bounds.end());
  EXPECT_LE(bounds[50], 1e-14);
}

TEST(SignalErrorBound, FarOrigins) {
  const Grid grid = random_field(16, 0, 6);
  for (const double distance : {1e3, 1e6, 1e10})
    for (std::uint64_t i = 0; i < 20; ++i) {
      SCOPED_TRACE("ray " + std::to_string(i));
      const Comparison comparison = expect_trilinear(grid, long_ray(grid, i, distance));
      EXPECT_LE(comparison.bound, error_of_way(grid, distance));
      EXPECT_LE(comparison.bound, 8 * comparison.observed);
      expect_tricubic(grid, CubicKernel::bspline, long_ray(grid, i, distance));
    }
}

TEST(SignalErrorBound, DegenerateRays) {
  for (const Grid& grid : {random_field(7, 0, 3), labels(7)}) {
    Grid box{.size = {5, 6, 7}, .spacing = {1, 1, 1}, .values = grid.values};
    box.values.resize(std::size_t{5} * 6 * 7);
    for (std::size_t i = 0; i < hard_rays().size(); ++i) {
      SCOPED_TRACE("ray " + std::to_string(i));
      expect_trilinear(box, hard_rays()[i]);
      expect_tricubic(box, CubicKernel::bspline, hard_rays()[i]);
      expect_tricubic(box, CubicKernel::catmull_rom, hard_rays()[i]);
    }
  }
}

TEST(SignalErrorBound, HoldWhereVolumesEndAtVoxelCentres) {
  const Grid grid = random_field(24, 0, 6);
  for (std::uint64_t i = 0; i < 60; ++i) {
    SCOPED_TRACE("ray " + std::to_string(i));
    const Comparison comparison = expect_trilinear(grid, long_ray(grid, i), 1, Border::voxel_centres);
    EXPECT_GE(comparison.points, 100U);
    EXPECT_LE(comparison.bound, error_of_way(grid));
    EXPECT_LE(comparison.bound, 8 * comparison.observed);
  }
  for (const Grid& values : {random_field(7, 0, 3), labels(7)}) {
    Grid box{.size = {5, 6, 7}, .spacing = {1, 1, 1}, .values = values.values};
    box.values.resize(std::size_t{5} * 6 * 7);
    for (std::size_t i = 0; i < hard_rays().size(); ++i) {
      SCOPED_TRACE("hard ray " + std::to_string(i));
      expect_trilinear(box, hard_rays()[i], 1, Border::voxel_centres);
      expect_tricubic(box, CubicKernel::bspline, hard_rays()[i], Border::voxel_centres);
      expect_tricubic(box, CubicKernel::catmull_rom, hard_rays()[i], Border::voxel_centres);
    }
  }
}

TEST(SignalErrorBound, FlatGridsAndSingleVoxels) {
  for (const std::array<std::int64_t, 3>& size :
       std::vector<std::array<std::int64_t, 3>>{{1, 1, 1}, {1, 8, 1}, {9, 1, 4}, {2, 2, 1}}) {
    Grid grid{.size = size, .spacing = {1, 1, 1}, .values = random_field(8, 0, 5).values};
    grid.values.resize(static_cast<std::size_t>(size[0] * size[1] * size[2]));
    for (std::uint64_t i = 0; i < 12; ++i) {
      expect_trilinear(grid, long_ray(grid, i));
      expect_tricubic(grid, CubicKernel::catmull_rom, long_ray(grid, i));
    }
  }
}

TEST(SignalErrorBound, LargeOffsetsCostTheirOwnUlpsOnly) {
  Grid grid = random_field(12, 0, 6);
  for (double& value : grid.values) value += 1e6;
  for (std::uint64_t i = 0; i < 20; ++i) {
    EXPECT_LE(expect_trilinear(grid, long_ray(grid, i)).bound, 4 * 0x1p-52 * 1e6);
    EXPECT_LE(expect_tricubic(grid, CubicKernel::bspline, long_ray(grid, i)).bound, 32 * 0x1p-52 * 1e6);
  }
}

TEST(SignalErrorBound, AThousandVoxelsLong) {
  Grid grid{.size = {1003, 3, 3}, .spacing = {1, 1, 1}, .values = random_field(21, 0, 5).values};
  grid.values.resize(std::size_t{1003} * 3 * 3);
  const Ray ray{{-7, -0.4, -0.3}, {1, 1.5e-3, 1.3e-3}};
  const Comparison comparison = expect_trilinear(grid, ray, 7);
  EXPECT_LE(comparison.bound, 4 * comparison.observed);
  EXPECT_LE(comparison.bound, 1e-12);
}

TEST(SignalErrorBound, EqualVoxelsGiveZero) {
  const Grid grid = labels(32);
  std::size_t constant_pieces = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Ray ray = long_ray(grid, i);
    expect_trilinear(grid, ray);
    const Chain<3> chain = trace_trilinear(grid, ray);
    const SignalError error = trilinear_error(grid, ray, chain);
    EXPECT_LE(error.unclaimed, 1e-11);
    for (std::size_t piece = 0; piece < chain.pieces.size(); ++piece) {
      const auto& b = chain.pieces[piece].polynomial.coefficients;
      if (b != std::array{0.1, 0.1, 0.1, 0.1} && b != std::array{0.7, 0.7, 0.7, 0.7}) continue;
      EXPECT_EQ(error.of_pieces[piece], 0);
      ++constant_pieces;
    }
  }
  EXPECT_GE(constant_pieces, 100U);
}

TEST(SignalErrorBound, WrongChainsAreFoundOut) {
  // The bound is about the chain it is given.
  const Grid grid = random_field(12, 0, 6);
  const Ray ray{{-3, 2.2, 3.3}, {1, 0.3, 0.4}};
  Chain<3> chain = trace_trilinear(grid, ray);
  chain.pieces[4].polynomial.coefficients[2] += 1e-3;
  chain.end = chain.end + 1e-3;
  const SignalError error = trilinear_error(grid, ray, chain);
  EXPECT_NEAR(error.of_pieces[4], 1e-3, 1e-14);
  EXPECT_LE(error.of_pieces[3], 1e-14);
  EXPECT_NEAR(error.of_length, 1e-3, 1e-14);
}

/// The exact B-spline coefficients, by elimination in 50 digits along each axis.
std::vector<Real50> exact_coefficients(const Grid& grid) {
  std::vector<Real50> values(grid.values.begin(), grid.values.end());
  const std::array<std::int64_t, 3> stride{1, grid.size[0], grid.size[0] * grid.size[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t count = grid.size[axis];
    if (count == 1) continue;
    for (std::int64_t first = 0; first < static_cast<std::int64_t>(values.size()); ++first) {
      if (first / stride[axis] % count != 0) continue;
      const auto at = [&](std::int64_t i) -> Real50& {
        return values[static_cast<std::size_t>(first + i * stride[axis])];
      };
      const auto diagonal = [&](std::int64_t i) { return i == 0 || i == count - 1 ? Real50(5) : Real50(4); };
      std::vector<Real50> pivot{diagonal(0)};
      for (std::int64_t i = 0; i < count; ++i) at(i) *= 6;
      for (std::int64_t i = 1; i < count; ++i) {
        at(i) -= at(i - 1) / pivot.back();
        pivot.push_back(diagonal(i) - 1 / pivot.back());
      }
      for (std::int64_t i = count; i-- > 0;)
        at(i) = (at(i) - (i + 1 < count ? at(i + 1) : Real50(0))) / pivot[static_cast<std::size_t>(i)];
    }
  }
  return values;
}

TEST(SignalErrorBound, PrefilterBoundHoldsAndIsNotSilly) {
  for (const std::array<std::int64_t, 3>& size :
       std::vector<std::array<std::int64_t, 3>>{{12, 11, 10}, {1, 30, 2}, {1, 1, 1}}) {
    Grid grid{.size = size, .spacing = {1, 1, 1}, .values = random_field(12, 0, 8).values};
    grid.values.resize(static_cast<std::size_t>(size[0] * size[1] * size[2]));
    const Grid coefficients = bspline_coefficients(grid);
    const auto exact = exact_coefficients(grid);
    double worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i)
      worst = std::max(worst, to_double(abs(exact[i] - coefficients.values[i])));
    const double bound = prefilter_error(grid, coefficients);
    EXPECT_LE(worst, bound);
    EXPECT_LE(bound, 100 * worst + 1e-26);  // or what 106 bits leave, on a single voxel
    EXPECT_LE(bound, 1e-13);
  }
}

TEST(SignalErrorBound, PrefilterErrorIsAddedToEveryPiece) {
  const Grid coefficients = bspline_coefficients(random_field(8, 0, 8));
  const Ray ray = long_ray(coefficients, 1);
  Chain<9> chain;
  trace_tricubic(coefficients, CubicKernel::bspline, ray, chain);
  const SignalError raw = tricubic_error(coefficients, CubicKernel::bspline, ray, chain);
  const SignalError prefiltered = tricubic_error(coefficients, CubicKernel::bspline, ray, chain, 0.125);
  for (std::size_t i = 0; i < chain.pieces.size(); ++i)
    EXPECT_DOUBLE_EQ(prefiltered.of_pieces[i], raw.of_pieces[i] + 0.125);
}

TEST(SignalErrorBound, PiecewisePolynomials) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const auto random = [trial](std::uint32_t i) { return random_numbers(7, RandomStream::points, trial, i)[0]; };
    std::vector<double> breaks{0};
    std::vector<std::vector<double>> coefficients;
    for (std::uint32_t i = 0; i < 10; ++i) {
      breaks.push_back(breaks.back() + std::exp(10 * random(i) - 5));
      const double length = breaks[i + 1] - breaks[i];
      coefficients.emplace_back();
      for (std::uint32_t k = 0; k < 1 + (trial + i) % 10; ++k)
        coefficients.back().push_back((2 * random(100 + 10 * i + k) - 1) / std::pow(length, k));
    }
    const Chain<largest_degree> chain = piecewise_polynomial(breaks, coefficients);
    const SignalError error = piecewise_polynomial_error(breaks, coefficients, chain);
    EXPECT_EQ(error.of_length, 0);
    std::size_t piece = 0;
    const Signal signal = [&](const Real50& t) {
      Real50 sum = 0;
      for (std::size_t k = coefficients[piece].size(); k-- > 0;)
        sum = sum * (t - breaks[piece]) + coefficients[piece][k];
      return sum;
    };
    // One piece at a time, since pieces jump.
    for (; piece < coefficients.size(); ++piece) {
      const Chain<largest_degree> part{{chain.pieces[piece]}, chain.end_of(piece)};
      const Comparison comparison = expect_bounds(signal, part, {{error.of_pieces[piece]}, 0});
      EXPECT_LE(comparison.bound, 100 * comparison.observed);
      EXPECT_EQ(comparison.bound == 0, coefficients[piece].size() == 1);
    }
  }
}

}  // namespace
}  // namespace raytruth
