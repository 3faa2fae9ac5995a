#include "raytruth/reference/arb_integral.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/gaussian_transfer.hpp"
#include "unit/support/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

using boost::math::constants::pi;

TEST(ArbIntegral, NoRayIsEmpty) {
  const PiecewiseLinear glow({{0, {1, {1, 1, 1}}}});
  expect_encloses(arb_integral(Chain<3>{}, glow, Emission::plain), Exact{}, 0);
}

constexpr auto integral = [](const auto& signal, const PiecewiseLinear& transfer, Emission emission) {
  return arb_integral(signal, transfer, emission);
};

// Half an ulp, the rounding of the result.
constexpr double precision = 1.2e-16;

TEST(ArbIntegral, ConstantSignals) { expect_constant_signals(integral, precision); }
TEST(ArbIntegral, ConstantSignalsAtAPointTakeItsRightHandValue) { expect_right_hand_values(integral, precision); }
TEST(ArbIntegral, LinearSignalsUnderALinearExtinction) { expect_linear_signals(integral, precision); }
TEST(ArbIntegral, AStepInTheTransferFunction) { expect_step(integral, precision); }
TEST(ArbIntegral, PolynomialsAgainstAMarchOf50Digits) { expect_march(integral, precision); }

TEST(ArbIntegral, ContactsThatNoArithmeticDecides) {
  const PiecewiseLinear step({{0.5, {0, {0, 0, 0}}}, {0.5, {4, {1, 1, 1}}}});
  // 1/2 - (u - 1/2)^2 stays below but for a point, 1/2 + (u - 1/2)^2 above; the tops of a quartic are flatter still.
  for (const Emission emission : both_emissions) {
    const auto below = piece(Bernstein<2>{{0.25, 0.75, 0.25}}.elevated<9>());
    const auto above = piece(Bernstein<2>{{0.75, 0.25, 0.75}}.elevated<9>());
    const Exact full = homogeneous(4, {1, 1, 1}, 1, emission);
    // Elevation rounds, so that the contact may be a crossing: some 1e-8 on either side.
    EXPECT_NEAR(arb_integral(below, step, emission).opacity, 0, 1e-7);
    EXPECT_NEAR(arb_integral(above, step, emission).opacity, static_cast<double>(full.opacity), 1e-7);
    expect_encloses(arb_integral(piece<3>({{0.25, 0.5, 0.5, 0.25}}), step, emission), Exact{}, 0);
    const Bernstein<9> touching{{0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.75}};
    expect_encloses(arb_integral(piece(touching), step, emission), full, 1.2e-16);
    // 3/8 - 3/8 (2u - 1)^2 + 1/8 has its top, exactly 1/2, at a point that halving meets; a ball remains about it.
    const Bernstein<3> top{{0.125, 0.625, 0.625, 0.125}};
    const Certified grazed = arb_integral(piece(top), step, emission);
    EXPECT_LE(grazed.opacity, grazed.radius);
    EXPECT_LE(grazed.radius, 1e-16);
  }
}

TEST(ArbIntegral, FaintAndOpaqueRays) {
  const PiecewiseLinear faint({{0, {0, {1, 1, 1}}}, {1, {2e-9, {1, 1, 1}}}});
  const Real50 opacity = -expm1(-Real50(2e-9) * 3 / 8);
  expect_encloses(arb_integral(linear(0, 0.75), faint, Emission::associated), {{opacity, opacity, opacity}, opacity},
                  1e-25);

  // What lies behind a depth of 1000 is left out, and covered by the radius.
  const PiecewiseLinear dense({{0.5, {2000, {0.5, 0.5, 0.5}}}, {0.5, {1000, {1e6, 1e6, 1e6}}}});
  Chain<3> signal;
  for (int i = 0; i < 4; ++i) {
    const double s = i == 0 ? 0.0 : 1.0;
    signal.pieces.push_back({static_cast<double>(i), 1, {{s, s, s, s}}});
  }
  signal.end = 4;
  expect_encloses(arb_integral(signal, dense, Emission::associated), {{0.5, 0.5, 0.5}, 1}, 1e-15);
}

TEST(ArbIntegral, LongChains) {
  const PiecewiseLinear ramp({{0, {0, {0, 0, 0}}}, {1, {0.001, {1, 1, 1}}}});
  Chain<3> signal;
  constexpr int pieces = 2000;
  for (int i = 0; i < pieces; ++i) {
    const double s = i % 2;
    signal.pieces.push_back({static_cast<double>(i), 1, {{s, s, 1 - s, 1 - s}}});
  }
  signal.end = pieces;
  const Certified certified = arb_integral(signal, ramp, Emission::associated);
  EXPECT_LE(certified.radius, 1.2e-16);
  EXPECT_LE(abs(-expm1(Real50(-0.001) * pieces / 2) - certified.opacity), certified.radius);
}

const AnalyticSignal& signal_named(std::string_view name) {
  const auto& signals = analytic_signals();
  return *std::find_if(signals.begin(), signals.end(), [&](const auto& signal) { return signal.name == name; });
}

Optics50 gaussian(const GaussianTransfer& transfer, const Real50& s) {
  const Real50 distance = (s - transfer.mean) / transfer.deviation;
  Optics50 optics{transfer.extinction * exp(-distance * distance / 2), {}};
  for (Eigen::Index i = 0; i < 3; ++i)
    optics.color[static_cast<std::size_t>(i)] = transfer.color[i] + s * transfer.color_slope[i];
  return optics;
}

constexpr auto evenly = [](int count, const Real50& end) {
  std::vector<Real50> knots;
  for (int i = 0; i <= count; ++i) knots.push_back(end * i / count);
  return knots;
};

TEST(ArbIntegral, AGaussianTransferFunction) {
  const GaussianTransfer transfer{0.5, 0.25, 3, {1, 0.5, 0}, {0, 0.5, 1}};
  for (const Emission emission : both_emissions) {
    const Exact sine = march([&](const Real50& t) { return gaussian(transfer, (1 + sin(pi<Real50>() * t / 8)) / 2); },
                             evenly(12, 16), emission);
    expect_encloses(arb_integral(signal_named("sine_slow"), transfer, emission), sine, 1e-15);

    const Bernstein<3> cubic{{0.125, 1.5, -0.625, 0.8125}};
    const Exact polynomial =
        march([&](const Real50& t) { return gaussian(transfer, value(cubic, t)); }, evenly(4, 1), emission);
    expect_encloses(arb_integral(piece(cubic), transfer, emission), polynomial, 1e-15);
  }
  EXPECT_THROW(arb_integral(constant(0), GaussianTransfer{.deviation = 0}, Emission::plain), InputError);
}

/// The chains of `expand` meet the signals to a few `expansion_tolerance`, and so do their integrals.
TEST(ArbIntegral, EveryAnalyticSignal) {
  const PiecewiseLinear tent({{0.25, {0.1, {0, 0, 1}}}, {0.5, {1, {1, 0.5, 0}}}, {0.75, {0, {0, 1, 0}}}});
  for (const AnalyticSignal& signal : analytic_signals())
    for (const Emission emission : both_emissions) {
      SCOPED_TRACE(signal.name);
      const Certified itself = arb_integral(signal, tent, emission);
      const Certified chain = arb_integral(expand(signal), tent, emission);
      const double tolerance = 16 * 8 * expansion_tolerance;
      EXPECT_LE(itself.radius, 1e-14);
      EXPECT_NEAR(itself.opacity, chain.opacity, tolerance);
      for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(itself.color[i], chain.color[i], 16 * tolerance);
    }
  AnalyticSignal unknown = analytic_signals().front();
  unknown.name = "unknown";
  EXPECT_THROW(arb_integral(unknown, tent, Emission::plain), InputError);
}

TEST(ArbIntegral, MarschnerLobbRays) {
  // On the axis rho = (3/2 - sin(pi z / 2)) / (5/2), whose integral from -1 to 1 is 6/5.
  const PiecewiseLinear ramp({{0, {0, {0, 0, 0}}}, {1, {2, {1, 1, 1}}}});
  for (const double z : {1.0, -1.0}) {
    const Certified axis = arb_integral(MarschnerLobbRay{{{0, 0, -5 * z}, {0, 0, 3 * z}}}, ramp, Emission::associated);
    EXPECT_LE(axis.radius, 1.2e-16);
    EXPECT_LE(abs(-expm1(Real50(-12) / 5) - axis.opacity), axis.radius);
  }
  // A diagonal of length 2 sqrt(3), in a fog; the same, from inside and cut.
  const PiecewiseLinear fog({{0, {0.5, {1, 0.5, 0.25}}}});
  for (const Emission emission : both_emissions) {
    const Ray diagonal{{-3, -3, -3}, {0.1, 0.1, 0.1}};
    expect_encloses(arb_integral(MarschnerLobbRay{diagonal}, fog, emission),
                    homogeneous(0.5, {1, 0.5, 0.25}, 2 * sqrt(Real50(3)), emission), 5e-16);
    expect_encloses(arb_integral(MarschnerLobbRay{{{0, 0, 0}, {1, 1, 0}}}, fog, emission),
                    homogeneous(0.5, {1, 0.5, 0.25}, sqrt(Real50(2)), emission), 5e-16);
    expect_encloses(arb_integral(MarschnerLobbRay{{{0, 0, 0}, {1, 1, 0}, 0.5}}, fog, emission),
                    homogeneous(0.5, {1, 0.5, 0.25}, 0.5, emission), 5e-16);
  }
  expect_encloses(arb_integral(MarschnerLobbRay{{{-2, 3, 0}, {1, 0, 0}}}, fog, Emission::plain), Exact{}, 0);
  EXPECT_THROW(arb_integral(MarschnerLobbRay{{{0, 0, 0}, {0, 0, 0}}}, fog, Emission::plain), InputError);

  // Across the axis, where sqrt(x^2 + y^2) is not smooth but the signal is.
  const GaussianTransfer transfer{0.5, 0.5, 2, {1, 0.5, 0}, {0, 0.5, 1}};
  const Exact exact = march(
      [&](const Real50& t) {
        const Real50 r = abs(t - 0.25);
        const Real50 ripple = cos(12 * pi<Real50>() * cos(pi<Real50>() / 2 * r));
        return gaussian(transfer, (1 - sin(pi<Real50>() / 8) + (1 + ripple) / 4) * 2 / 5);
      },
      evenly(4, 0.5), Emission::associated);
  expect_encloses(arb_integral(MarschnerLobbRay{{{-0.25, 0, 0.25}, {1, 0, 0}, 0.5}}, transfer, Emission::associated),
                  exact, 1e-15);

  const Ray ray{{-2, 0.1, 0.2}, {1, 0.05, -0.1}};
  const Certified oblique = arb_integral(MarschnerLobbRay{ray}, transfer, Emission::plain);
  const Certified chain = arb_integral(trace_marschner_lobb(ray), transfer, Emission::plain);
  EXPECT_NEAR(oblique.opacity, chain.opacity, 64 * expansion_tolerance);
  EXPECT_NEAR(oblique.color[0], chain.color[0], 64 * expansion_tolerance);
}

}  // namespace
}  // namespace raytruth
