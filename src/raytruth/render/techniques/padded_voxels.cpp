#include "raytruth/render/techniques/padded_voxels.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

template <class Number>
PaddedVoxels<Number>::PaddedVoxels(const Grid& grid, double low, double scale)
    : stride_{grid.size[0] + 2, (grid.size[0] + 2) * (grid.size[1] + 2)},
      values_(static_cast<std::size_t>(stride_[1] * (grid.size[2] + 2))) {
  tbb::parallel_for(std::int64_t{0}, grid.size[2] + 2, [&](std::int64_t k) {
    const auto clamped = [&grid](std::int64_t i, std::size_t axis) {
      return std::clamp(i - 1, std::int64_t{0}, grid.size[axis] - 1);
    };
    Number* out = values_.data() + k * stride_[1];
    for (std::int64_t j = 0; j < grid.size[1] + 2; ++j)
      for (std::int64_t i = 0; i < grid.size[0] + 2; ++i)
        *out++ = static_cast<Number>((grid.at(clamped(i, 0), clamped(j, 1), clamped(k, 2)) - low) * scale);
  });
}

template class PaddedVoxels<float>;
template class PaddedVoxels<double>;

bool are_binary32(const Grid& grid) {
  return std::all_of(grid.values.begin(), grid.values.end(), [](double value) {
    // Numbers beyond the range of binary32 have no conversion.
    return std::abs(value) <= std::numeric_limits<float>::max() &&
           static_cast<double>(static_cast<float>(value)) == value;
  });
}

}  // namespace raytruth
