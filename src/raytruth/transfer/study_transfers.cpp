#include "raytruth/transfer/study_transfers.hpp"

#include "raytruth/core/random.hpp"

#include <cmath>
#include <initializer_list>
#include <utility>

namespace raytruth {

namespace {

TransferPoint blue_to_red(double s, double extinction) { return {s, {extinction, {s, 0.5, 1 - s}}}; }

PiecewiseLinear through(std::initializer_list<std::pair<double, double>> extinctions) {
  std::vector<TransferPoint> points;
  points.reserve(extinctions.size());
  for (const auto& [s, extinction] : extinctions) points.push_back(blue_to_red(s, extinction));
  return PiecewiseLinear(std::move(points));
}

}  // namespace

PiecewiseLinear ramp_transfer(double extinction) { return through({{0, 0}, {1, extinction}}); }

PiecewiseLinear tent_transfer(double extinction) {
  return through({{0, 0}, {0.4, 0}, {0.5, extinction}, {0.6, 0}, {1, 0}});
}

PiecewiseLinear isoslab_transfer(double extinction) {
  constexpr double front = 0.5 - 1.0 / 512;
  constexpr double back = 0.5 + 1.0 / 512;
  return through({{0, 0}, {front, 0}, {front, extinction}, {back, extinction}, {back, 0}, {1, 0}});
}

PiecewiseLinear step_transfer(double extinction) {
  return through({{0, 0}, {0.5, 0}, {0.5, extinction}, {1, extinction}});
}

PiecewiseLinear gaussian_transfer(double extinction) {
  constexpr int intervals = 1024;
  std::vector<TransferPoint> points;
  for (int i = 0; i <= intervals; ++i) {
    const double s = static_cast<double>(i) / intervals;
    const double deviations = (s - 0.5) / 0.05;
    points.push_back(blue_to_red(s, extinction * std::exp(-deviations * deviations / 2)));
  }
  return PiecewiseLinear(std::move(points));
}

PiecewiseLinear random_transfer(double extinction, std::uint64_t seed) {
  constexpr std::uint64_t entries = 256;
  std::vector<TransferPoint> points;
  for (std::uint64_t i = 0; i < entries; ++i) {
    const auto number = random_numbers(seed, RandomStream::transfers, i);
    points.push_back({static_cast<double>(i) / static_cast<double>(entries - 1),
                      {extinction * number[0], {number[1], number[2], number[3]}}});
  }
  return PiecewiseLinear(std::move(points));
}

}  // namespace raytruth
