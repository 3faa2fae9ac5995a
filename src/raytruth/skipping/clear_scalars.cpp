#include "raytruth/skipping/clear_scalars.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace raytruth {

ClearScalars::ClearScalars(const PiecewiseLinear& transfer, Emission emission) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto& points = transfer.points();
  const auto is_clear = [&](std::size_t i) {
    const Optics& optics = points[i].optics;
    return optics.extinction == 0 && (emission == Emission::associated || (optics.color == 0).all());
  };
  // Stretch i lies between points i - 1 and i; at a jump it is a single scalar.
  const std::size_t count = points.size();
  const auto stretch_is_clear = [&](std::size_t i) {
    return (i == 0 || is_clear(i - 1)) && (i == count || is_clear(i));
  };
  for (std::size_t first = 0; first <= count; ++first) {
    if (!stretch_is_clear(first)) continue;
    std::size_t last = first;
    while (last < count && stretch_is_clear(last + 1)) ++last;
    double high = last == count ? infinity : points[last].s;
    // At a jump the scalar itself has the value from the right.
    if (last + 1 < count && points[last + 1].s == high) high = std::nextafter(high, -infinity);
    intervals_.push_back({first == 0 ? -infinity : points[first - 1].s, high});
    first = last;
  }
}

bool ClearScalars::contain(double low, double high) const {
  const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), low,
                                      [](double s, const Interval& interval) { return s < interval.low; });
  return after != intervals_.begin() && high <= (after - 1)->high;
}

}  // namespace raytruth
