#pragma once

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
Proportion clustered_proportion(const std::vector<Cluster>& clusters);

}  // namespace raytruth
