#include "raytruth/signals/cell_walk.hpp"

namespace raytruth {

Span clip(const std::array<std::int64_t, 3>& size, Border border, const std::array<double, 3>& origin,
          const std::array<double, 3>& direction) {
  Span span;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = -margin_of(border);
    const double high = static_cast<double>(size[axis] - 1) + margin_of(border);
    if (direction[axis] == 0) {
      if (origin[axis] < low || origin[axis] > high) return {0.0, 0.0};
      continue;
    }
    const bool ascending = direction[axis] > 0;
    const auto reaches = [&](double border) { return two_sum(border, -origin[axis]) / direction[axis]; };
    span.begin = std::max(span.begin, reaches(ascending ? low : high));
    span.end = std::min(span.end, reaches(ascending ? high : low));
  }
  return span;
}

}  // namespace raytruth
