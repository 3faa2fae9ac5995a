#include "raytruth/statistics/rank_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace raytruth {

namespace {

constexpr std::size_t fewest_pairs = 5;
constexpr double normal_quantile = 1.959963984540054;  // of 97.5 %

/// The ranks of the values: 1, 2, ... in ascending order, ties at their mean.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&values](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[order[i]] = static_cast<double>(first + 1 + end) / 2;
  }
  return ranks;
}

RankCorrelation with_interval(double estimate, double variance) {
  const double half_width = normal_quantile * std::sqrt(variance);
  const double middle = std::atanh(estimate);
  return {estimate, std::tanh(middle - half_width), std::tanh(middle + half_width)};
}

int sign(double x) { return (x > 0) - (x < 0); }

}  // namespace

std::optional<RankCorrelation> spearman(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() < fewest_pairs) return {};
  const auto count = static_cast<double>(x.size());
  const auto x_ranks = ranks_of(x);
  const auto y_ranks = ranks_of(y);
  const double mean = (count + 1) / 2;
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = x_ranks[i] - mean;
    const double b = y_ranks[i] - mean;
    xx += a * a;
    xy += a * b;
    yy += b * b;
  }
  if (xx == 0 || yy == 0) return {};
  return with_interval(std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0), 1.06 / (count - 3));
}

std::optional<RankCorrelation> kendall(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() < fewest_pairs) return {};
  std::int64_t balance = 0;
  std::int64_t untied_in_x = 0;
  std::int64_t untied_in_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const std::int64_t a = sign(x[i] - x[j]);
      const std::int64_t b = sign(y[i] - y[j]);
      balance += a * b;
      untied_in_x += a * a;
      untied_in_y += b * b;
    }
  if (untied_in_x == 0 || untied_in_y == 0) return {};
  const double norm = std::sqrt(static_cast<double>(untied_in_x)) * std::sqrt(static_cast<double>(untied_in_y));
  return with_interval(std::clamp(static_cast<double>(balance) / norm, -1.0, 1.0),
                       0.437 / (static_cast<double>(x.size()) - 4));
}

}  // namespace raytruth
