#pragma once

#include "raytruth/core/chain.hpp"

#include <algorithm>
#include <limits>

namespace raytruth {

/// How far rounding moves xi_max, and xi per unit length, of a trilinear ray with values in [0, 1]. In epsilons: 12 for
/// a coefficient (local coordinates, three interpolations, the mean of three corners), 5 more for a sample, at most 23
/// more for the coefficients of an approximation from samples at comparable distances; 64 leaves room for the sums.
inline constexpr double signal_radius = 64 * std::numeric_limits<double>::epsilon();

/// xi = integral_0^L |s(t) - s^(t)| dt, in scalar times length (El Hajjar 2008, section 3.2).
///
/// Exact but for rounding: on every interval on which both signals are one polynomial, the difference is split where it
/// changes sign and integrated in closed form.
template <int Degree, int ApproximateDegree, class Real>
Real xi(const Chain<Degree, Real>& signal, const Chain<ApproximateDegree, Real>& approximation) {
  constexpr int degree = std::max(Degree, ApproximateDegree);
  Real sum(0);
  for_each_common_interval(signal, approximation, [&](const auto& s, const auto& approximate, const Real& length) {
    const auto difference = s.template elevated<degree>() - approximate.template elevated<degree>();
    sum = sum + length * difference.integral_of_magnitude();
  });
  return sum;
}

/// xi_max = max |s(t) - s^(t)|: of the extrema of the difference on every such interval.
template <int Degree, int ApproximateDegree, class Real>
Real xi_max(const Chain<Degree, Real>& signal, const Chain<ApproximateDegree, Real>& approximation) {
  constexpr int degree = std::max(Degree, ApproximateDegree);
  Real largest(0);
  for_each_common_interval(signal, approximation, [&](const auto& s, const auto& approximate, const Real& /*length*/) {
    const auto [low, high] = (s.template elevated<degree>() - approximate.template elevated<degree>()).range();
    largest = std::max(largest, std::max(high, Real(-low)));
  });
  return largest;
}

}  // namespace raytruth
