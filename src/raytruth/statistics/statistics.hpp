#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace raytruth {

/// The quantile at `probability` in [0, 1] of ascending values, linear between order statistics: type 7 of
/// R. J. Hyndman and Y. Fan, Sample quantiles in statistical packages, 1996. `sorted` must not be empty.
inline double quantile(const std::vector<double>& sorted, double probability) {
  const double rank = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

/// Where `value` lies in ascending values: the share below it plus half the share equal to it, in [0, 1].
/// `sorted` must not be empty.
inline double percentile_of(const std::vector<double>& sorted, double value) {
  const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
  const auto below = static_cast<double>(first - sorted.begin());
  const auto equal = static_cast<double>(last - first);
  return (below + equal / 2) / static_cast<double>(sorted.size());
}

}  // namespace raytruth
