#include "raytruth/statistics/grid_interpolation.hpp"

#include "raytruth/core/error.hpp"

#include <cmath>
#include <iterator>

namespace raytruth {

namespace {

/// The value that is linear between the two items around, whose values `value_of` gives, and constant beyond the ends.
template <class Item, class ValueOf>
double interpolated(const std::map<double, Item>& items, double place, ValueOf&& value_of) {
  const auto next = items.lower_bound(place);
  if (next == items.begin()) return value_of(next->second);
  const auto before = std::prev(next);
  if (next == items.end()) return value_of(before->second);
  const double share = (place - before->first) / (next->first - before->first);
  return std::lerp(value_of(before->second), value_of(next->second), share);
}

}  // namespace

GridInterpolation::GridInterpolation(const std::vector<PlaneValue>& values) {
  if (values.empty()) throw InputError("a plane is interpolated between one value at least");
  std::map<double, std::map<double, int>> counts;
  for (const auto& [x, y, value] : values) {
    double& mean = lines_[y][x];
    mean += (value - mean) / ++counts[y][x];
  }
}

double GridInterpolation::operator()(double x, double y) const {
  return interpolated(lines_, y,
                      [x](const Line& line) { return interpolated(line, x, [](double value) { return value; }); });
}

}  // namespace raytruth
