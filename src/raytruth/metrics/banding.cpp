#include "raytruth/metrics/banding.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace raytruth {

namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double sum_of_squares_about_mean(const std::vector<double>& values) {
  const double mean = mean_of(values);
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [mean](double sum, double value) { return sum + (value - mean) * (value - mean); });
}

/// By how much a sequence rises at most, from any item to a later one.
double largest_rise(const std::vector<double>& items) {
  double lowest = items.front();
  double rise = 0;
  for (const double item : items) {
    lowest = std::min(lowest, item);
    rise = std::max(rise, item - lowest);
  }
  return rise;
}

std::vector<double> window_of(const std::vector<double>& values, std::int64_t width, std::int64_t left,
                              std::int64_t top, std::int64_t side) {
  std::vector<double> window;
  for (std::int64_t row = top; row < top + side; ++row) {
    const auto first = values.begin() + row * width + left;
    window.insert(window.end(), first, first + side);
  }
  return window;
}

}  // namespace

std::vector<double> autocorrelation(const std::vector<double>& values, const std::array<std::int64_t, 2>& size,
                                    const std::array<std::int64_t, 2>& step, std::int64_t lags) {
  const double mean = mean_of(values);
  const double variance = sum_of_squares_about_mean(values) / static_cast<double>(values.size());
  std::vector<double> result{1};
  const auto [width, height] = size;
  for (std::int64_t lag = 1; lag <= lags; ++lag) {
    const std::int64_t across = lag * step[0];
    const std::int64_t down = lag * step[1];
    double sum = 0;
    std::int64_t pairs = 0;
    for (std::int64_t row = std::max<std::int64_t>(0, -down); row < std::min(height, height - down); ++row)
      for (std::int64_t column = std::max<std::int64_t>(0, -across); column < std::min(width, width - across);
           ++column) {
        const auto here = static_cast<std::size_t>(row * width + column);
        const auto there = static_cast<std::size_t>((row + down) * width + column + across);
        sum += (values[here] - mean) * (values[there] - mean);
        ++pairs;
      }
    result.push_back(variance > 0 && pairs > 0 ? sum / (static_cast<double>(pairs) * variance) : 0);
  }
  return result;
}

Banding banding(const std::vector<double>& values, const std::array<std::int64_t, 2>& size, std::int64_t side) {
  constexpr std::int64_t least_side = 8;
  if (side < least_side || size[0] < side || size[1] < side)
    throw InputError(fmt::format("found windows of {} pixels in an image of {} x {}; {} up to the image are allowed",
                                 side, size[0], size[1], least_side));
  constexpr std::array<std::array<std::int64_t, 2>, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  double squares = 0;
  double weighted = 0;
  double pixels = 0;
  for (std::int64_t top = 0; top + side <= size[1]; top += side / 2)
    for (std::int64_t left = 0; left + side <= size[0]; left += side / 2) {
      const std::vector<double> window = window_of(values, size[0], left, top, side);
      double rise = 0;
      for (const auto& direction : directions)
        rise = std::max(rise, largest_rise(autocorrelation(window, {side, side}, direction, side / 2)));
      const double its_squares = sum_of_squares_about_mean(window);
      weighted += std::min(1.0, rise / 2) * its_squares;
      squares += its_squares;
      pixels += static_cast<double>(window.size());
    }
  if (!(squares > 0)) return {};
  return {weighted / squares, std::sqrt(weighted / pixels)};
}

}  // namespace raytruth
