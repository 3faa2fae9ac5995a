#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/erf.hpp>

#include <array>
#include <functional>
#include <vector>

namespace raytruth {

/// The volume rendering integral in 50 digits, without a bound of its own.
struct Exact {
  std::array<Real50, 3> color{};
  Real50 opacity = 0;
};

/// What a transfer function says, in 50 digits.
struct Optics50 {
  Real50 extinction;
  std::array<Real50, 3> color;
};

/// Gauss' rule of 30 nodes.
template <class Function>
void for_each_node(const Real50& begin, const Real50& end, const Function& visit) {
  using Rule = boost::math::quadrature::gauss<Real50, 30>;
  const Real50 middle = (begin + end) / 2;
  const Real50 half = (end - begin) / 2;
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i)
    for (const int side : {-1, 1}) visit(middle + side * half * Rule::abscissa()[i], half * Rule::weights()[i]);
}

/// A march in 50 digits: Gauss' rule for the colour between consecutive `knots`, between which all is smooth, and once
/// more for the depth from the last knot to every node.
inline Exact march(const std::function<Optics50(const Real50&)>& optics, const std::vector<Real50>& knots,
                   Emission emission) {
  Exact result;
  Real50 depth = 0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const auto depth_to = [&](const Real50& end) {
      Real50 sum = depth;
      for_each_node(knots[i], end,
                    [&](const Real50& t, const Real50& weight) { sum += weight * optics(t).extinction; });
      return sum;
    };
    for_each_node(knots[i], knots[i + 1], [&](const Real50& t, const Real50& weight) {
      const auto [tau, color] = optics(t);
      const Real50 visible = weight * exp(-depth_to(t)) * (emission == Emission::associated ? tau : Real50(1));
      for (std::size_t channel = 0; channel < 3; ++channel) result.color[channel] += visible * color[channel];
    });
    depth = depth_to(knots[i + 1]);
  }
  result.opacity = -expm1(-depth);
  return result;
}

/// Every value lies within the radius, and the radius is no larger than asked.
inline void expect_encloses(const Certified& certified, const Exact& exact, double largest_radius) {
  EXPECT_EQ(certified.status, Status::converged);
  EXPECT_LE(certified.radius, largest_radius);
  const Real50 radius = certified.radius;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LE(abs(exact.color[i] - certified.color[static_cast<Eigen::Index>(i)]), radius)
        << "channel " << i << ": " << certified.color[static_cast<Eigen::Index>(i)] << " for " << exact.color[i];
  EXPECT_LE(abs(exact.opacity - certified.opacity), radius) << certified.opacity << " for " << exact.opacity;
}

/// A homogeneous stretch.
inline Exact homogeneous(const Real50& extinction, const std::array<Real50, 3>& color, const Real50& length,
                         Emission emission) {
  Exact exact;
  exact.opacity = -expm1(-extinction * length);
  for (std::size_t i = 0; i < 3; ++i) {
    const Real50 visible = extinction == 0 ? length : Real50(exact.opacity / extinction);
    exact.color[i] = emission == Emission::associated ? Real50(color[i] * exact.opacity) : Real50(color[i] * visible);
  }
  return exact;
}

/// The integral of exp(k x^2) up to x, from infinity for k < 0: by the error function; from 0 for k > 0: by the series
/// of Dawson's function, whose terms are all positive.
inline Real50 gaussian_integral(const Real50& k, const Real50& x) {
  if (k < 0) return -sqrt(boost::math::constants::pi<Real50>() / -k) / 2 * boost::math::erfc(Real50(sqrt(-k) * x));
  Real50 sum = 0;
  Real50 term = x;
  for (int n = 1; term > 1e-55 * sum; ++n) {
    sum += term / (2 * n - 1);
    term *= k * x * x / n;
  }
  return sum;
}

/// p(u) by de Casteljau's algorithm, in 50 digits.
template <int Degree>
Real50 value(const Bernstein<Degree>& polynomial, const Real50& u) {
  Bernstein<Degree, Real50> exact;
  std::copy(polynomial.coefficients.begin(), polynomial.coefficients.end(), exact.coefficients.begin());
  return exact.value(u);
}

/// Where a polynomial meets s, found on a grid and refined by bisection.
template <int Degree>
void add_crossings(const Bernstein<Degree>& polynomial, double s, std::vector<Real50>& knots) {
  constexpr int grid = 256;
  for (int i = 0; i < grid; ++i) {
    Real50 low = Real50(i) / grid;
    Real50 high = Real50(i + 1) / grid;
    const bool rises = value(polynomial, high) > s;
    if (rises == (value(polynomial, low) > s)) continue;
    for (int halving = 0; halving < 160; ++halving) {
      const Real50 middle = (low + high) / 2;
      ((value(polynomial, middle) > s) == rises ? high : low) = middle;
    }
    knots.push_back(low);
  }
}

inline Optics50 interpolated(const PiecewiseLinear& transfer, const Real50& s) {
  const auto& points = transfer.points();
  const auto exact = [](const Optics& optics) {
    return Optics50{optics.extinction, {optics.color[0], optics.color[1], optics.color[2]}};
  };
  if (s <= points.front().s) return exact(points.front().optics);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (s > points[i].s) continue;
    const Real50 weight = (s - points[i - 1].s) / (Real50(points[i].s) - points[i - 1].s);
    Optics50 a = exact(points[i - 1].optics);
    const Optics50 b = exact(points[i].optics);
    a.extinction += weight * (b.extinction - a.extinction);
    for (std::size_t k = 0; k < 3; ++k) a.color[k] += weight * (b.color[k] - a.color[k]);
    return a;
  }
  return exact(points.back().optics);
}

}  // namespace raytruth
