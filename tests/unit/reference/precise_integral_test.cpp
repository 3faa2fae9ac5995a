#include "raytruth/reference/arb/exact_cut.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/integral_cases.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/closed_forms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

// Rays in 106 bits, and cut without rounding: at jumps of any height, in contacts of any order, from afar, and where
// the scalar is large against the distances of the transfer function's points. Against closed forms, Arb, and rays of
// which no more than the numbers differ.
namespace raytruth {
namespace {

const Vector3<double> red{0.9, 0.5, 0.2};
const Vector3<double> blue{0.1, 0.2, 0.3};

std::string text(const Certified& answer) {
  std::ostringstream stream;
  stream.precision(17);
  stream << answer.color.transpose() << ", opacity " << answer.opacity << " +- " << answer.radius;
  return stream.str();
}

/// Below 0 `low` in red, above it `high` in blue.
PiecewiseLinear step(double low, double high, double place = 0) {
  return PiecewiseLinear(
      {{place - 1, {low, red}}, {place, {low, red}}, {place, {high, blue}}, {place + 1, {high, blue}}});
}

void expect_near(const Certified& answer, const Vector3<double>& color, double opacity, double most) {
  EXPECT_LE(answer.radius, most);
  EXPECT_NEAR(answer.opacity, opacity, answer.radius + 1e-16) << text(answer);
  EXPECT_LE((answer.color - color).abs().maxCoeff(), answer.radius + 1e-16) << text(answer);
}

/// (t - 1/2)^n touches 0 for even n, and the ray stays on one side of the jump there; for odd n it crosses it at 1/2.
TEST(PreciseIntegral, ContactsOfAnyOrderAtAJump) {
  for (const double high : {1.0, 1e9})
    for (int order = 1; order <= 9; ++order) {
      SCOPED_TRACE(order);
      std::vector<double> powers{1};
      for (int i = 0; i < order; ++i) {
        powers.push_back(0);
        for (std::size_t k = powers.size() - 1; k > 0; --k) powers[k] = powers[k - 1] - powers[k] / 2;
        powers[0] /= -2;
      }
      RayIntegral integral(step(100, high), Emission::associated);
      const Certified answer = integral(precise_piecewise_polynomial({0, 1}, {powers}));
      const double front = order % 2 == 0 ? 0 : 50;
      const double opacity = -std::expm1(-high * (order % 2 == 0 ? 1 : 0.5));
      const Vector3<double> color = red * -std::expm1(-front) + blue * (std::exp(-front) * opacity);
      expect_near(answer, color, -std::expm1(-front) + std::exp(-front) * opacity, 3e-14);
      // The other side, touched from below.
      for (double& power : powers) power = -power;
      if (order % 2 == 0) expect_near(integral(precise_piecewise_polynomial({0, 1}, {powers})), red, 1, 1e-14);
    }
}

/// A chain that stands for itself needs not be asked for in 106 bits.
TEST(PreciseIntegral, ChainsThatStandForThemselves) {
  Chain<3> parabola{{{0.0, 1, {{3, -1, -1, 3}}}}, 1.0};
  const Certified above = RayIntegral(step(1e6, 2), Emission::associated)(parabola);
  expect_near(above, blue * -std::expm1(-2), -std::expm1(-2), 1e-14);
  for (double& b : parabola.pieces[0].polynomial.coefficients) b = -b;
  expect_near(RayIntegral(step(2, 1e6), Emission::associated)(parabola), red * -std::expm1(-2), -std::expm1(-2), 1e-14);
  // A constant on the jump is above it.
  const Chain<3> level{{{0.0, 1, {{0, 0, 0, 0}}}}, 1.0};
  expect_near(RayIntegral(step(1e6, 2), Emission::associated)(level), blue * -std::expm1(-2), -std::expm1(-2), 1e-14);
}

TEST(PreciseIntegral, JumpsOfAnyHeight) {
  for (const double height : {1e6, 1e13, 1e18, 1e30, 1e100}) {
    SCOPED_TRACE(height);
    // t/3 + t^2 crosses 0.3 once; in front of that 0.5 in red.
    RayIntegral integral(step(0.5, height, 0.3), Emission::associated);
    const double crossing = (std::sqrt(1.0 / 9 + 1.2) - 1.0 / 3) / 2;
    const double front = -std::expm1(-0.5 * crossing);
    expect_near(integral(precise_piecewise_polynomial({0, 1}, {{0, 1.0 / 3, 1}})), red * front + blue * (1 - front), 1,
                1e-13);
    // A slab of that extinction between two jumps, of the optical depth 1.
    const double width = std::max(1 / height, 0x1p-52);
    const PiecewiseLinear slab(
        {{0.5, {0, red}}, {0.5, {1 / width, blue}}, {0.5 + width, {1 / width, blue}}, {0.5 + width, {0, red}}});
    const Certified thin = RayIntegral(slab, Emission::associated)(precise_piecewise_polynomial({0, 1}, {{0, 1}}));
    const double depth = ((0.5 + width) - 0.5) / width;
    expect_near(thin, blue * -std::expm1(-depth), -std::expm1(-depth), 1e-14);
  }
}

/// Random rays at jumps, most of which binary64 cannot decide.
TEST(PreciseIntegral, AgreesWithArb) {
  constexpr std::uint64_t seed = 29;
  int closer = 0;
  for (std::uint64_t index = 0; index < 120; ++index) {
    const auto shape = index % 3 == 0   ? SignalShape::tangent
                       : index % 3 == 1 ? SignalShape::level
                                        : SignalShape::random;
    const auto transfer = index % 2 == 0 ? TransferShape::jumps : TransferShape::isoslab;
    const IntegralCase asked = random_case(shape, transfer, seed, index);
    std::visit(
        [&](const auto& signal) {
          for (const Emission emission : both_emissions) {
            SCOPED_TRACE(testing::Message() << "case " << index << " of seed " << seed);
            RayIntegral integral(asked.transfer, emission);
            const Certified here = integral(precise_chain(signal));
            const Certified there = arb_integral(signal, asked.transfer, emission);
            EXPECT_LE(difference_in_radii(here, there), 1) << text(here) << "\n" << text(there);
            closer += here.status == Status::converged ? 1 : 0;
          }
        },
        asked.signal);
  }
  EXPECT_GE(closer, 200);
}

/// Parts of one polynomial: where it is beyond a knot, how long, and on which side it touches one.
TEST(PreciseIntegral, CutsWithoutRounding) {
  PrecisePiece<3> piece{.length = 1, .polynomial = {{3.0, -1.0, -1.0, 3.0}}, .error = 0, .powers = {}, .extent = {}};
  EXPECT_EQ(arb::exact_cut(piece, {0.0}).size(), 1U);
  EXPECT_EQ(arb::exact_cut(piece, {0.0})[0].first_interval, 1U);
  const auto parts = arb::exact_cut(piece, {0.0, 0.03});
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[1].first_interval, 1U);
  EXPECT_EQ(parts[1].last_interval, 1U);
  EXPECT_NEAR(parts[1].width.high, 0.1, 1e-16);  // 3 (2 u - 1)^2 is below 0.03 on a tenth
  // Within its error of a knot nothing is decided.
  piece.error = 0.03;
  const auto unsure = arb::exact_cut(piece, {0.0});
  ASSERT_EQ(unsure.size(), 3U);
  EXPECT_EQ(unsure[1].first_interval, 0U);
  EXPECT_EQ(unsure[1].last_interval, 1U);
}

Grid eighths(double offset) {
  Grid grid = random_field(5, 0, 11);
  for (double& value : grid.values) value = offset + std::round(64 * value) / 64;
  return grid;
}

template <class Field>
Certified truth_of(const Field& field, const Ray& ray, const PiecewiseLinear& transfer) {
  return RayIntegral(transfer, Emission::associated)(field.trace_precisely(ray));
}

PiecewiseLinear jagged(double offset) {
  return PiecewiseLinear({{offset, {0, red}},
                          {offset + 0.25, {2, blue}},
                          {offset + 0.5, {1, red}},
                          {offset + 0.5, {3, blue}},
                          {offset + 1, {0.25, red}}});
}

/// A number that is added to all voxels and to all points changes nothing, however large.
TEST(PreciseIntegral, VoxelOffsetsCostNoDigits) {
  const Ray ray{.origin = {-1, 0.3, 0.7}, .direction = {1, 0.31, 0.27}};
  for (const FieldKind kind : {FieldKind::trilinear, FieldKind::bspline, FieldKind::catmull_rom}) {
    const Grid plain = eighths(0);
    const Certified usual = std::visit([&](const auto& field) { return truth_of(field, ray, jagged(0)); },
                                       ray_field(plain, kind, Border::half_voxel));
    for (const double offset : {0x1p10, 0x1p20, 0x1p30}) {
      SCOPED_TRACE(offset);
      const Grid shifted = eighths(offset);
      const Certified answer = std::visit([&](const auto& field) { return truth_of(field, ray, jagged(offset)); },
                                          ray_field(shifted, kind, Border::half_voxel));
      EXPECT_LE(answer.radius, 1e-12);
      EXPECT_LE(difference_in_radii(answer, usual), 1) << text(answer) << "\n" << text(usual);
    }
  }
}

/// Nor does an origin from far away, on the same line.
TEST(PreciseIntegral, FarOriginsCostNoDigits) {
  const Grid grid = eighths(0);
  const std::array<double, 3> direction{1, 0.375, 0.25};
  for (const FieldKind kind : {FieldKind::trilinear, FieldKind::bspline}) {
    const auto answer_from = [&](double distance) {
      Ray ray{.origin = {2, 1.75, 1.625}, .direction = direction};
      for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] -= distance * direction[axis];
      return std::visit([&](const auto& field) { return truth_of(field, ray, jagged(0)); },
                        ray_field(grid, kind, Border::half_voxel));
    };
    const Certified usual = answer_from(8);
    for (const double distance : {0x1p10, 0x1p20, 0x1p30}) {
      const Certified answer = answer_from(distance);
      EXPECT_LE(answer.radius, 1e-13);
      EXPECT_LE(difference_in_radii(answer, usual), 1) << text(answer) << "\n" << text(usual);
    }
  }
}

/// Equal voxels on a jump take its right-hand value, whatever is beside their row or plane.
TEST(PreciseIntegral, RowsOfEqualVoxelsOnAJump) {
  Grid grid = random_field(5, 0, 12);
  for (std::int64_t y = 0; y < 5; ++y)
    for (std::int64_t x = 0; x < 5; ++x) grid.values[static_cast<std::size_t>(grid.index(x, y, 2))] = 0.5;
  const PiecewiseLinear transfer = step(100, 2, 0.5);
  for (const Ray& ray :
       {Ray{.origin = {-3, 1, 2}, .direction = {3, 0, 0}}, Ray{.origin = {1, 7, 2}, .direction = {0, -1, 0}},
        Ray{.origin = {-2, 0.3, 2}, .direction = {1, 0.5, 0}}}) {
    Chain<3> chain;
    const TrilinearField field(grid);
    field.trace(ray, chain);
    const Certified answer = RayIntegral(transfer, Emission::associated)(chain, field.error(ray, chain));
    const double opacity = -std::expm1(-2 * chain.length());
    expect_near(answer, blue * opacity, opacity, 1e-14);
  }
}

}  // namespace
}  // namespace raytruth
