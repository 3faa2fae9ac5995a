#pragma once

#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// A grid with one more voxel at each end, equal to its neighbour, so that the clamped field needs no clamping; each
/// voxel as (value - low) scale, computed in binary64 and kept as a Number, float or double.
template <class Number>
class PaddedVoxels {
 public:
  explicit PaddedVoxels(const Grid& grid, double low = 0, double scale = 1);

  /// Where voxel (i - 1, j - 1, k - 1) of the grid lies.
  [[nodiscard]] const Number* at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return values_.data() + (i + j * stride_[0] + k * stride_[1]);
  }
  [[nodiscard]] const Number* data() const { return values_.data(); }
  [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(values_.size()); }
  /// From a voxel to the next one along y and along z.
  [[nodiscard]] const std::array<std::int64_t, 2>& stride() const { return stride_; }

 private:
  std::array<std::int64_t, 2> stride_;
  std::vector<Number> values_;
};

extern template class PaddedVoxels<float>;
extern template class PaddedVoxels<double>;

/// Whether binary32 holds every voxel exactly, as those of integers up to 2^24 and of files in binary32.
bool are_binary32(const Grid& grid);

}  // namespace raytruth
