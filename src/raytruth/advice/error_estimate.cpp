#include "raytruth/advice/error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>

namespace raytruth {

namespace {

/// The index of the tail above the k-th largest of descending errors, and the means of ln(x_i / x_k) and x_i - x_k.
struct Tail {
  double index = 0;
  double mean_log = 0;
  double mean_excess = 0;
};

Tail tail_of(const std::vector<double>& descending, std::size_t k) {
  double first = 0;
  double second = 0;
  double excess = 0;
  for (std::size_t i = 0; i < k; ++i) {
    const double log = std::log(descending[i] / descending[k]);
    first += log;
    second += log * log;
    excess += (descending[i] - descending[k]) / static_cast<double>(k);
  }
  first /= static_cast<double>(k);
  second /= static_cast<double>(k);
  if (!(second > first * first)) return {-1, first, excess};
  const double index = first + 1 - 0.5 / (1 - first * first / second);
  return {std::clamp(index, -1.0, 1.0), first, excess};
}

}  // namespace

ErrorEstimate rmse_of_sample(const std::vector<double>& squares, double confidence) {
  const auto n = static_cast<double>(squares.size());
  if (squares.size() < 2) return error_of_all(ErrorKind::rmse, squares);
  const double mean = std::accumulate(squares.begin(), squares.end(), 0.0) / n;
  double variance = 0;
  for (const double square : squares) variance += (square - mean) * (square - mean) / (n - 1);
  const double largest = *std::max_element(squares.begin(), squares.end());
  const double log = std::log(2 / (1 - confidence));
  const double spread = std::sqrt(2 * variance * log / n) + 7 * 2 * largest * log / (3 * (n - 1));
  const double standard_error = std::sqrt(variance / n);
  return {std::sqrt(mean), std::sqrt(std::max(0.0, mean - 2 * standard_error)), std::sqrt(mean + spread)};
}

ErrorEstimate error_of_all(ErrorKind kind, const std::vector<double>& errors) {
  if (errors.empty()) return {};
  const double error =
      kind == ErrorKind::rmse
          ? std::sqrt(std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size()))
          : *std::max_element(errors.begin(), errors.end());
  return {error, error, error};
}

ErrorEstimate largest_of_sample(std::vector<double> errors, double population, double confidence) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end(), std::greater<>());
  const auto n = static_cast<double>(errors.size());
  const double seen = errors.front();
  const double unseen = std::max(1.0, population / n);
  // A margin of a tenth where everything was seen but once, of more where only a few pixels were.
  constexpr double margin = 0.1;
  const double least = seen * (1 + margin * std::log10(10 * unseen));
  constexpr std::size_t fewest = 10;
  const std::size_t k = std::max(fewest, errors.size() / 10);
  if (errors.size() <= k || !(errors[k] > 0)) return {seen, seen, least};
  const Tail tail = tail_of(errors, k);
  const auto extreme = [&](double share) {
    const double beyond = std::log(static_cast<double>(k) * unseen / share);
    const double growth = std::abs(tail.index) < 1e-6 ? beyond : std::expm1(tail.index * beyond) / tail.index;
    return errors[k] +
           std::max(errors[k] * tail.mean_log * (1 - std::min(tail.index, 0.0)) * growth, tail.mean_excess * beyond);
  };
  // The tail of an image is none that is known: what one part of it does, another part may not tell.
  constexpr double unknown_tail = 1.5;
  return {std::max(seen, extreme(1)), seen, unknown_tail * std::max(least, extreme(1 - confidence))};
}

ErrorEstimate and_at_least(ErrorEstimate estimate, double found) {
  constexpr double margin = 1.1;
  return {std::max(estimate.value, found), std::max(estimate.low, found), std::max(estimate.high, margin * found)};
}

}  // namespace raytruth
