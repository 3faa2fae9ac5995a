#pragma once

#include "raytruth/core/error.hpp"

#include <cmath>
#include <iterator>
#include <map>
#include <vector>

namespace raytruth {

/// A value at a place of a plane.
struct PlaneValue {
  double x = 0;
  double y = 0;
  double value = 0;
};

/// MATLAB's interp2(x, y, z, ...): bilinear between values on a grid; beyond it, where interp2 has no answer, that of
/// the nearest edge. Places need not fill the grid: values are linear in x along the lines of equal y, then linear in y
/// between the two lines around. Several values at one place are replaced by their mean.
class GridInterpolation {
 public:
  /// Throws InputError without values.
  explicit GridInterpolation(const std::vector<PlaneValue>& values) {
    if (values.empty()) throw InputError("a plane is interpolated between one value at least");
    std::map<double, std::map<double, int>> counts;
    for (const auto& [x, y, value] : values) {
      double& mean = lines_[y][x];
      mean += (value - mean) / ++counts[y][x];
    }
  }

  [[nodiscard]] double operator()(double x, double y) const {
    return interpolated(lines_, y,
                        [x](const Line& line) { return interpolated(line, x, [](double value) { return value; }); });
  }

 private:
  using Line = std::map<double, double>;

  /// The value that is linear between the two items around, whose values `value_of` gives, and constant beyond the
  /// ends.
  template <class Item, class ValueOf>
  static double interpolated(const std::map<double, Item>& items, double place, ValueOf&& value_of) {
    const auto next = items.lower_bound(place);
    if (next == items.begin()) return value_of(next->second);
    const auto before = std::prev(next);
    if (next == items.end()) return value_of(before->second);
    const double share = (place - before->first) / (next->first - before->first);
    return std::lerp(value_of(before->second), value_of(next->second), share);
  }

  std::map<double, Line> lines_;
};

}  // namespace raytruth
