#include "signals/cell_walk.hpp"

namespace raytruth {

Stretch clip(const std::array<std::int64_t, 3>& size, const std::array<double, 3>& origin,
             const std::array<double, 3>& direction) {
  Stretch stretch;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = -0.5;
    const double high = static_cast<double>(size[axis]) - 0.5;
    if (direction[axis] == 0) {
      if (origin[axis] < low || origin[axis] > high) return {0.0, 0.0};
      continue;
    }
    const bool ascending = direction[axis] > 0;
    const auto reaches = [&](double border) { return two_sum(border, -origin[axis]) / direction[axis]; };
    stretch.begin = std::max(stretch.begin, reaches(ascending ? low : high));
    stretch.end = std::min(stretch.end, reaches(ascending ? high : low));
  }
  return stretch;
}

}  // namespace raytruth
