#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace raytruth {

/// The autocorrelation of values about their mean, at lags 0 to `lags` in units of a step (columns, rows): the mean
/// product over all pairs of the rectangle, over the variance. All 0 but the first where the values do not vary.
///
/// `values` row by row, `size` columns and rows.
std::vector<double> autocorrelation(const std::vector<double>& values, const std::array<std::int64_t, 2>& size,
                                    const std::array<std::int64_t, 2>& step, std::int64_t lags);

/// What of an image's values comes back at a distance, as stripes do.
struct Banding {
  double share = 0;      ///< 0: none; 1: stripes all over
  double amplitude = 0;  ///< root mean square of what comes back
};

/// Stripes make the autocorrelation r fall and rise again; values that merely vary smoothly make it fall. So the
/// banding of a window is the largest rise
///     max over j < k of (r(k) - r(j)) / 2,  0 <= j < k <= side / 2, at most 1,
/// in the worst of four directions (along rows, columns and both diagonals): 1 for a sinusoid of a period of up to half
/// a side. Windows overlap by half; `share` is their mean weighted by their sums of squares about their means, and
/// amplitude^2 = share times the mean square about the windows' means. White noise has a share of some 3 / side, by the
/// chance of so many lags. Throws InputError for a side below 8, or an image smaller than a window.
Banding banding(const std::vector<double>& values, const std::array<std::int64_t, 2>& size, std::int64_t side);

}  // namespace raytruth
