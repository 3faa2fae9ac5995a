#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/integral_cases.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/closed_forms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

// The reference's radius holds, and is small, where lengths, extinctions and colours are far from 1: where their
// products leave the range of binary64, where nothing is left of a ray's light, where a number is subnormal.
namespace raytruth {
namespace {

constexpr std::uint64_t seed = 23;

std::string text(const Certified& answer) {
  std::ostringstream stream;
  stream.precision(17);
  stream << answer.color.transpose() << ", opacity " << answer.opacity << " +- " << answer.radius;
  return stream.str();
}

/// Powers of two by which a case is multiplied.
struct Powers {
  int length = 0;
  int extinction = 0;
  int color = 0;
};

template <int Degree>
Chain<Degree> times(Chain<Degree> signal, const Powers& powers) {
  signal.end = 0;
  for (auto& piece : signal.pieces) {
    piece.length = std::ldexp(piece.length, powers.length);
    piece.start = signal.end;
    signal.end += piece.length;
  }
  return signal;
}

PiecewiseLinear times(const PiecewiseLinear& transfer, const Powers& powers) {
  std::vector<TransferPoint> points = transfer.points();
  std::vector<OpacityPoint> opacity_points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Optics& optics = points[i].optics;
    optics.extinction = std::ldexp(optics.extinction, powers.extinction);
    for (double& channel : optics.color) channel = std::ldexp(channel, powers.color);
    if (transfer.is_linear_in_opacity()) opacity_points.push_back({points[i].s, transfer.opacities()[i], optics.color});
  }
  if (!transfer.is_linear_in_opacity()) return PiecewiseLinear(points);
  return from_opacity(opacity_points, std::ldexp(transfer.unit_length(), -powers.extinction));
}

/// From -1 to 1.
double uniform(std::uint64_t index, std::uint32_t which) {
  return 2 * random_numbers(seed, RandomStream::points, index, which)[0] - 1;
}

/// Powers that the transfer function's limits allow, the optical depth between 2^-1090 and 2^8.
Powers random_powers(std::uint64_t index, const PiecewiseLinear& transfer) {
  double most = 0;
  for (const TransferPoint& point : transfer.points()) most = std::max(most, point.optics.extinction);
  const int depth = index % 3 == 0 ? 0 : static_cast<int>(-540 + 548 * uniform(index, 0));
  const int length = static_cast<int>(-60 + 1000 * uniform(index, 1));
  const int least = transfer.is_linear_in_opacity() ? -900 : -1040;
  const int limit = 499 - std::ilogb(std::max(most, 1e-300));
  const int extinction = std::clamp(depth - length, least, limit);
  return {.length = std::clamp(depth - extinction, -1070, 1010),
          .extinction = extinction,
          .color = static_cast<int>(-280 + 770 * uniform(index, 2))};
}

void expect_agreement(const Chain<9>& signal, const PiecewiseLinear& transfer, Emission emission) {
  const Certified here = RayIntegral(transfer, emission)(signal);
  const Certified there = arb_integral(signal, transfer, emission);
  EXPECT_LE(difference_in_radii(here, there), 1) << text(here) << "\n" << text(there);
}

class Sizes : public testing::TestWithParam<int> {};

TEST_P(Sizes, AgreeWithArb) {
  constexpr std::uint64_t cases = 40;
  for (std::uint64_t index = 0; index < cases; ++index) {
    const bool is_linear = index % 4 != 0;
    const auto shape = static_cast<SignalShape>(GetParam());
    const IntegralCase ordinary =
        is_linear
            ? random_case(shape, static_cast<TransferShape>(index % transfer_shapes.size()), seed, index)
            : random_opacity_case(shape, static_cast<OpacityShape>(index / 4 % opacity_shapes.size()), seed, index);
    const Powers powers = random_powers(index, ordinary.transfer);
    const PiecewiseLinear transfer = times(ordinary.transfer, powers);
    std::visit(
        [&](const auto& of_ordinary_size) {
          const auto signal = times(of_ordinary_size, powers);
          for (const Emission emission : both_emissions) {
            SCOPED_TRACE(testing::Message() << "case " << index << " of seed " << seed << " by 2^" << powers.length
                                            << ", 2^" << powers.extinction << ", 2^" << powers.color << ", "
                                            << (emission == Emission::plain ? "plain" : "associated"));
            const Certified here = RayIntegral(transfer, emission)(signal);
            const Certified there = arb_integral(signal, transfer, emission);
            if (!std::isfinite(there.radius)) continue;  // above all numbers
            EXPECT_LE(difference_in_radii(here, there), 1) << text(here) << "\n" << text(there);
            // Nor does the radius say little, where no scalar is within rounding of a point.
            const bool is_decided = shape == SignalShape::random || shape == SignalShape::short_pieces;
            if (!is_decided || !is_linear || emission == Emission::plain) continue;
            EXPECT_LE(here.radius, 1e-9 * std::max(there.color.maxCoeff(), there.opacity) + 1e-305) << text(here);
          }
        },
        ordinary.signal);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Sizes, testing::Range(0, static_cast<int>(signal_shapes.size())),
                         [](const auto& shape) {
                           return std::string(signal_shapes[static_cast<std::size_t>(shape.param)]);
                         });

/// A bound of 0 stands only where nothing is there to be seen.
TEST(Sizes, NoBoundIsZeroWhereSomethingIs) {
  const Chain<9> flat = piecewise_polynomial({0, 1e-10}, {{0.5}});
  for (const Emission emission : both_emissions) {
    const PiecewiseLinear faint({{0, {1.1e-320, {1.3e-300, 2.7e-300, 3.1e-301}}}});
    const Certified answer = RayIntegral(faint, emission)(flat);
    EXPECT_GT(answer.radius, 0);
    EXPECT_LE(answer.radius, 1e-320);
    const Certified nothing = RayIntegral(PiecewiseLinear({{0, {0, {0, 0, 0}}}}), emission)(flat);
    EXPECT_EQ(nothing.radius, 0);
  }
  const Certified clear = RayIntegral(PiecewiseLinear({{0, {0, {1, 1, 1}}}, {1, {0, {1, 1, 1}}}, {2, {1, {1, 1, 1}}}}),
                                      Emission::associated)(flat);
  EXPECT_LE(clear.radius, 1e-300);
  EXPECT_EQ(clear.opacity, 0);
}

/// s(u) = (u / L)^9 on a length L of any size: what matters is u / L.
TEST(Sizes, PowersOfALengthMayBeOutOfRange) {
  const PiecewiseLinear ramp({{0, {0, {0, 0, 0}}}, {1, {2, {1, 0.5, 0.25}}}});
  for (const Emission emission : both_emissions) {
    const Certified usual = RayIntegral(ramp, emission)(piecewise_polynomial({0, 1}, {{0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}));
    for (const int exponent : {-113, -100, -40, 35, 100, 113}) {
      SCOPED_TRACE(exponent);
      const double length = std::ldexp(1, exponent);
      const std::vector<double> coefficients{0, 0, 0, 0, 0, 0, 0, 0, 0, std::ldexp(1, -9 * exponent)};
      const Chain<9> chain = piecewise_polynomial({0, length}, {coefficients});
      const SignalError error = piecewise_polynomial_error({0, length}, {coefficients}, chain);
      Certified answer = RayIntegral(times(ramp, {.extinction = -exponent}), emission)(chain, error);
      if (emission == Emission::plain) answer.color /= length;
      EXPECT_EQ(answer.opacity, usual.opacity);
      EXPECT_EQ((answer.color - usual.color).abs().maxCoeff(), 0);
    }
  }
  // Zeros overflow nothing, however long the ray.
  const Chain<9> flat = piecewise_polynomial({0, 1e300}, {{0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0}});
  EXPECT_TRUE(flat.is_constant());
  const Certified answer = RayIntegral(ramp, Emission::associated)(flat);
  EXPECT_NEAR(answer.opacity, 1, answer.radius);
  EXPECT_NEAR(answer.color[0], 0.5, answer.radius);
  EXPECT_LE(answer.radius, 3e-14);
}

/// 1 - exp(-tau L) and its colour, of any optical depth.
TEST(Sizes, HomogeneousMediaOfAnyDepth) {
  const Vector3<double> color{0.3, 0.6, 0.9};
  for (const int exponent : {-300, 0, 6, 15, 16, 20, 100, 290}) {
    const double length = std::pow(10, exponent);
    const Chain<9> flat = piecewise_polynomial({0, length / 4, length}, {{0.5}, {0.25}});
    for (const double extinction : {1.0, 1e15, 1e40, 0x1p499}) {
      SCOPED_TRACE(testing::Message() << length << " of " << extinction);
      const double depth = extinction * length;
      const double opacity = -std::expm1(-depth);
      const PiecewiseLinear transfer({{0, {extinction, color}}});
      const Certified associated = RayIntegral(transfer, Emission::associated)(flat);
      EXPECT_EQ(associated.status, Status::converged);
      EXPECT_NEAR(associated.opacity, opacity, associated.radius + 1e-15 * opacity);
      EXPECT_LE(associated.radius, 3e-14 * opacity);
      EXPECT_LE((associated.color - color * opacity).abs().maxCoeff(), associated.radius + 1e-15 * opacity);
      const Certified plain = RayIntegral(transfer, Emission::plain)(flat);
      const double light = depth < 1e-8 ? length : opacity / extinction;
      EXPECT_LE((plain.color - color * light).abs().maxCoeff(), plain.radius + 1e-8 * light);
    }
  }
  // Behind what is opaque nothing is in doubt, whatever its depth.
  const Chain<9> line = piecewise_polynomial({0, 1, 2}, {{0.5}, {0, 1}});
  const PiecewiseLinear dense({{0, {1e20, color}}, {1, {3e21, color}}});
  expect_agreement(line, dense, Emission::associated);
  EXPECT_LE(RayIntegral(dense, Emission::associated)(line).radius, 1e-13);
}

}  // namespace
}  // namespace raytruth
