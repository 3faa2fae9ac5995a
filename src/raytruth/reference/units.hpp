#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

/// Units in which the numbers of a ray are of ordinary size: powers of two, so that nothing is rounded but what falls
/// below 2^-1022 in these units too.
struct Units {
  int length = 0;      ///< a length of 1 is 2^length of those that were given
  int extinction = 0;  ///< likewise
  int color = 0;

  /// 0; or less where the whole ray is so faint, below 2^-200, that its light and its opacity are proportional to the
  /// extinction, but for 2^-200 of themselves: then the extinction is multiplied.
  [[nodiscard]] int depth() const { return length + extinction; }
};

/// The units in which a ray of this length is about 1 long, the largest colour about 1, and the largest optical depth
/// not below 2^-201, as far as no extinction is above 2^500.
Units units_for(const PiecewiseLinear& transfer, double length);

/// Opacities that are multiplied become extinctions, which is off by 2^-52 of them at most.
PiecewiseLinear in_units(const PiecewiseLinear& transfer, const Units& units);

template <int Degree>
Chain<Degree> in_units(Chain<Degree> signal, const Units& units);

SignalError in_units(SignalError error, const Units& units);

}  // namespace raytruth
