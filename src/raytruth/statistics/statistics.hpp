#pragma once

#include <vector>

namespace raytruth {

/// The quantile at `probability` in [0, 1] of ascending values, linear between order statistics: type 7 of
/// R. J. Hyndman and Y. Fan, Sample quantiles in statistical packages, 1996. `sorted` must not be empty.
double quantile(const std::vector<double>& sorted, double probability);

/// Where `value` lies in ascending values: the share below it plus half the share equal to it, in [0, 1].
/// `sorted` must not be empty.
double percentile_of(const std::vector<double>& sorted, double value);

}  // namespace raytruth
