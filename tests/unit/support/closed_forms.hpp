#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/real50_integral.hpp"

#include <algorithm>

namespace raytruth {

// What every reference must enclose: integral(signal, transfer, emission) is its Certified answer, whose radius is at
// most `precision` times the largest value, or as good as zero.

inline constexpr double nothing = 1e-20;

inline constexpr std::array both_emissions{Emission::associated, Emission::plain};

/// A chain of one piece.
template <int Degree>
Chain<Degree> piece(const Bernstein<Degree>& polynomial, double length = 1) {
  return {{{0.0, length, polynomial}}, length};
}

inline Chain<3> constant(double s, double length = 1) { return piece<3>({{s, s, s, s}}, length); }

/// Exact if (b - a) / 3 and its multiples are.
inline Chain<3> linear(double a, double b) { return piece(Bernstein<1>{{a, b}}.elevated<3>()); }

inline double size(const Exact& exact) {
  Real50 largest = exact.opacity;
  for (const Real50& color : exact.color) largest = std::max(largest, color);
  return static_cast<double>(largest);
}

/// `dark`: the radius per length that is allowed where plain emission sends out nothing.
template <class Integral>
void expect_constant_signals(const Integral& integral, double precision, double dark = 0) {
  for (const Emission emission : both_emissions)
    for (const double depth : {0.0, 1e-9, 0.01, 0.3, 3.0, 30.0, 1e5})
      for (const double length : {1e-9, 0.1, 1.0, 100.0}) {
        const PiecewiseLinear ramp({{0, {0, {0, 0, 0}}}, {1, {depth / length, {1, 0.5, 0.25}}}});
        for (const double s : {-1.0, 0.0, 0.75, 1.0, 2.0}) {
          SCOPED_TRACE(testing::Message() << "depth " << depth << " length " << length << " s " << s);
          const Real50 x = std::clamp(s, 0.0, 1.0);
          const Exact exact = homogeneous(x * (depth / length), {x, x / 2, x / 4}, length, emission);
          expect_encloses(integral(constant(s, length), ramp, emission), exact,
                          precision * size(exact) + nothing + (emission == Emission::plain ? dark * length : 0));
        }
      }
}

template <class Integral>
void expect_right_hand_values(const Integral& integral, double precision) {
  const PiecewiseLinear steps({{0.5, {7, {1, 1, 1}}}, {0.5, {2, {0.5, 0.25, 0}}}, {0.75, {4, {1, 0, 1}}}});
  for (const Emission emission : both_emissions) {
    expect_encloses(integral(constant(0.5), steps, emission), homogeneous(2, {0.5, 0.25, 0}, 1, emission), precision);
    expect_encloses(integral(constant(0.75), steps, emission), homogeneous(4, {1, 0, 1}, 1, emission), precision);
    expect_encloses(integral(constant(std::nextafter(0.5, 0)), steps, emission), homogeneous(7, {1, 1, 1}, 1, emission),
                    precision);
  }
}

/// s from a to b on a length of 1 under tau(s) = m s, c(s) = s: with g = b - a and depth m (s^2 - a^2) / (2 g),
///     integral T dt = integral from a to b of exp(-m (s^2 - a^2) / (2 g)) ds / g,
///     integral s T dt = (1 - T(1)) / m,  integral tau s T dt = a - b T(1) + g integral T dt, by parts.
template <class Integral>
void expect_linear_signals(const Integral& integral, double precision) {
  for (const double m : {0.01, 1.0, 20.0, 1000.0})
    for (const auto& [a, b] : {std::pair{0.0, 0.75}, {0.75, 0.0}, {0.25, 0.625}, {0.875, 0.125}}) {
      const Real50 g = b - a;
      const Real50 k = -m / (2 * g);
      const Real50 clear = exp(-k * a * a) * (gaussian_integral(k, b) - gaussian_integral(k, a)) / g;
      const Real50 transmittance = exp(-m * (Real50(a) + b) / 2);
      const PiecewiseLinear ramp({{0, {0, {0, 0, 1}}}, {1, {m, {1, 0.5, 1}}}});
      const Real50 opacity = -expm1(-m * (Real50(a) + b) / 2);
      const Real50 associated = a - b * transmittance + g * clear;
      const Real50 plain = opacity / m;
      expect_encloses(integral(linear(a, b), ramp, Emission::associated),
                      {{associated, associated / 2, opacity}, opacity}, precision);
      expect_encloses(integral(linear(a, b), ramp, Emission::plain), {{plain, plain / 2, clear}, opacity}, precision);
    }
}

template <class Integral>
void expect_step(const Integral& integral, double precision) {
  const PiecewiseLinear step({{0.375, {0, {0, 0, 0}}}, {0.375, {4, {1, 0.5, 0.25}}}});
  for (const Emission emission : both_emissions)
    for (const Chain<3>& signal : {linear(0, 0.75), linear(0.75, 0)})
      expect_encloses(integral(signal, step, emission), homogeneous(4, {1, 0.5, 0.25}, 0.5, emission), precision);
}

/// Up, down and up across three points, one of them a jump, against the march in 50 digits.
template <class Integral, int Degree>
void expect_march(const Integral& integral, const Bernstein<Degree>& polynomial, double precision) {
  const PiecewiseLinear transfer(
      {{0.375, {0.5, {0, 1, 0}}}, {0.5, {8, {1, 0.5, 0.25}}}, {0.5, {1, {0.25, 0, 1}}}, {0.625, {12, {0.5, 0.75, 0}}}});
  std::vector<Real50> knots{0, 0.25, 0.5, 0.75, 1};
  for (const double s : {0.375, 0.5, 0.625}) add_crossings(polynomial, s, knots);
  ASSERT_EQ(knots.size(), 14U);
  std::sort(knots.begin(), knots.end());
  for (const Emission emission : both_emissions) {
    const Exact exact =
        march([&](const Real50& t) { return interpolated(transfer, value(polynomial, t)); }, knots, emission);
    expect_encloses(integral(piece(polynomial), transfer, emission), exact, precision);
  }
}

template <class Integral>
void expect_march(const Integral& integral, double precision) {
  const Bernstein<3> cubic{{0, 2, -1, 1}};
  expect_march(integral, cubic, precision);
  expect_march(integral, cubic.elevated<9>(), precision);  // rounded, so another polynomial
}

}  // namespace raytruth
