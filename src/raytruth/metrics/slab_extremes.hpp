#pragma once

#include <boost/math/tools/minima.hpp>

#include <cstdint>
#include <limits>
#include <utility>

namespace raytruth {

/// The largest value of a function over 0 <= s <= 1, and where it is: the largest on a grid, refined by Brent's method
/// between its neighbours. For functions that the grid resolves; such a value is right to the square of the place's
/// error.
template <class Real, class Function>
std::pair<Real, Real> largest_over_slab(const Function& function, int intervals = 128) {
  Real best = 0;
  Real largest = function(Real(0));
  for (int i = 1; i <= intervals; ++i) {
    const Real s = Real(i) / intervals;
    const Real value = function(s);
    if (value > largest) {
      largest = value;
      best = s;
    }
  }
  const Real width = Real(1) / intervals;
  const Real low = best > width ? Real(best - width) : Real(0);
  const Real high = best + width < 1 ? Real(best + width) : Real(1);
  std::uintmax_t iterations = 100;
  const auto [s, negative] =
      boost::math::tools::brent_find_minima([&](const Real& at) { return Real(-function(at)); }, low, high,
                                            std::numeric_limits<double>::digits / 2, iterations);
  return -negative > largest ? std::pair{s, Real(-negative)} : std::pair{best, largest};
}

}  // namespace raytruth
