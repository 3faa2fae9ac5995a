#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace raytruth {

/// A scalar volume on a regular grid. Voxel (i, j, k) has its centre at (i, j, k) in voxel coordinates, x fastest;
/// values are in physical units and finite; `spacing` is the distance of voxel centres per axis.
struct Grid {
  std::array<std::int64_t, 3> size{};
  std::array<double, 3> spacing{1, 1, 1};
  std::vector<double> values;

  [[nodiscard]] std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * size[1] + j) * size[0] + i);
  }

  [[nodiscard]] double at(std::int64_t i, std::int64_t j, std::int64_t k) const { return values[index(i, j, k)]; }

  /// Smallest and largest value.
  [[nodiscard]] std::pair<double, double> range() const {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low, *high};
  }
};

}  // namespace raytruth
