#pragma once

#include <optional>
#include <vector>

namespace raytruth {

/// A correlation of ranks, in [-1, 1], with a 95 % confidence interval for independent pairs.
struct RankCorrelation {
  double estimate = 0;
  double low = 0;
  double high = 0;
};

/// Spearman's rho of pairs (x_i, y_i): Pearson's correlation of the ranks, ties at their mean rank. The interval is
/// symmetric in atanh(rho), whose variance is 1.06 / (n - 3) (E. C. Fieller, H. O. Hartley and E. S. Pearson, Tests for
/// rank correlation coefficients, 1957). None for fewer than 5 pairs, or where all x or all y are tied.
std::optional<RankCorrelation> spearman(const std::vector<double>& x, const std::vector<double>& y);

/// Kendall's tau-b: concordant minus discordant pairs of pairs, over the geometric mean of the numbers that are not
/// tied in x and not tied in y (M. G. Kendall, Rank correlation methods, 1948). The interval is symmetric in
/// atanh(tau), whose variance is 0.437 / (n - 4) (Fieller, Hartley and Pearson 1957). None for fewer than 5 pairs, or
/// where all x or all y are tied.
std::optional<RankCorrelation> kendall(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace raytruth
