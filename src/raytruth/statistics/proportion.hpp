#pragma once

#include "raytruth/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {

/// Trials that are not independent of one another, as the cells of one ray.
struct Cluster {
  std::int64_t hits = 0;
  std::int64_t trials = 0;
};

/// A share with a 95 % confidence interval.
struct Proportion {
  double estimate = 0;
  double low = 0;
  double high = 0;
};

/// The share p = sum hits / sum trials of independent clusters, and the interval p +- 1.96 deviations of that ratio
/// (W. G. Cochran, Sampling techniques, 1977, section 6.3), cut to [0, 1]:
///     variance = m / (m - 1) sum (hits_i - p trials_i)^2 / (sum trials)^2, m clusters with trials.
/// Without a single hit: up to 1 - 0.05^(1/m), as if every cluster were one trial. Throws InputError without trials.
inline Proportion clustered_proportion(const std::vector<Cluster>& clusters) {
  double hits = 0;
  double trials = 0;
  double count = 0;
  for (const Cluster& cluster : clusters) {
    hits += static_cast<double>(cluster.hits);
    trials += static_cast<double>(cluster.trials);
    count += cluster.trials > 0 ? 1 : 0;
  }
  if (count == 0) throw InputError("a share of no trials at all; longer rays are allowed");
  if (hits == 0) return {0, 0, -std::expm1(std::log(0.05) / count)};
  const double estimate = hits / trials;
  if (count == 1) return {estimate, 0, 1};
  double squares = 0;
  for (const Cluster& cluster : clusters) {
    const double deviation = static_cast<double>(cluster.hits) - estimate * static_cast<double>(cluster.trials);
    squares += deviation * deviation;
  }
  constexpr double two_sided_95_percent = 1.959963984540054;
  const double reach = two_sided_95_percent * std::sqrt(count / (count - 1) * squares) / trials;
  return {estimate, std::max(estimate - reach, 0.0), std::min(estimate + reach, 1.0)};
}

}  // namespace raytruth
