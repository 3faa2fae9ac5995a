#pragma once

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
  explicit GridInterpolation(const std::vector<PlaneValue>& values);

  [[nodiscard]] double operator()(double x, double y) const;

 private:
  using Line = std::map<double, double>;

  std::map<double, Line> lines_;
};

}  // namespace raytruth
