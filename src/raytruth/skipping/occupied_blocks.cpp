#include "raytruth/skipping/occupied_blocks.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace raytruth {

OccupiedBlocks::OccupiedBlocks(const Grid& grid, const ClearScalars& clear, std::int64_t size,
                               const BlockRefinement& refinement)
    : size_(size) {
  if (size < 1) throw InputError(fmt::format("blocks of {} voxels; 1 or more are allowed", size));
  for (std::size_t axis = 0; axis < 3; ++axis)
    count_[axis] = std::max(std::int64_t{1}, (grid.size[axis] - 1 + size - 1) / size);
  occupied_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
  const auto voxels = [&](std::int64_t block, std::size_t axis) {
    return std::pair{std::max(block * size - refinement.growth, std::int64_t{0}),
                     std::min((block + 1) * size + refinement.growth, grid.size[axis] - 1)};
  };
  tbb::parallel_for(std::int64_t{0}, count_[2] * count_[1], [&](std::int64_t row) {
    const auto [first_k, last_k] = voxels(row / count_[1], 2);
    const auto [first_j, last_j] = voxels(row % count_[1], 1);
    for (std::int64_t i = 0; i < count_[0]; ++i) {
      const auto [first_i, last_i] = voxels(i, 0);
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (std::int64_t z = first_k; z <= last_k; ++z)
        for (std::int64_t y = first_j; y <= last_j; ++y)
          for (const double *v = grid.values.data() + grid.index(first_i, y, z), *const last = v + (last_i - first_i);
               v <= last; ++v) {
            low = std::min(low, *v);
            high = std::max(high, *v);
          }
      const double beyond = refinement.overshoot * (high - low) + refinement.margin;
      occupied_[static_cast<std::size_t>(row * count_[0] + i)] = clear.contain(low - beyond, high + beyond) ? 0 : 1;
    }
  });
}

void OccupiedBlocks::parts(const std::array<double, 3>& entry, const std::array<double, 3>& direction, double length,
                           std::vector<RayPart>& parts) const {
  constexpr double slack = 1e-6;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  parts.clear();
  const auto size = static_cast<double>(size_);
  std::array<std::int64_t, 3> block{};
  std::array<std::int64_t, 3> step{};
  std::array<double, 3> crossing{};  // where the ray leaves the block along each axis
  const auto crossing_of = [&](std::size_t axis) {
    const std::int64_t border = block[axis] + (step[axis] > 0 ? 1 : 0);
    // Beyond the outermost blocks there are only the clamped halves, which belong to them.
    if (step[axis] == 0 || border <= 0 || border >= count_[axis]) return infinity;
    return (static_cast<double>(border) * size - entry[axis]) / direction[axis];
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block[axis] =
        std::clamp(static_cast<std::int64_t>(std::floor(entry[axis] / size)), std::int64_t{0}, count_[axis] - 1);
    step[axis] = direction[axis] > 0 ? 1 : direction[axis] < 0 ? -1 : 0;
    crossing[axis] = crossing_of(axis);
  }
  for (double t = 0; t < length;) {
    const auto axis = static_cast<std::size_t>(std::min_element(crossing.begin(), crossing.end()) - crossing.begin());
    const double next = std::min(crossing[axis], length);
    if (at(block[0], block[1], block[2]) != 0) {
      const RayPart part{std::max(0.0, t - slack), std::min(length, next + slack)};
      if (!parts.empty() && part.begin <= parts.back().end)
        parts.back().end = part.end;
      else
        parts.push_back(part);
    }
    if (!(next < length)) break;
    t = std::max(t, next);
    block[axis] += step[axis];
    crossing[axis] = crossing_of(axis);
  }
}

double OccupiedBlocks::share() const {
  return static_cast<double>(std::accumulate(occupied_.begin(), occupied_.end(), std::int64_t{0})) /
         static_cast<double>(occupied_.size());
}

}  // namespace raytruth
