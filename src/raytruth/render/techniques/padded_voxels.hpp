#pragma once

#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// A grid in binary32 with one more voxel at each end, equal to its neighbour, so that the clamped field needs no
/// clamping; each voxel as (value - low) scale.
class PaddedVoxels {
 public:
  explicit PaddedVoxels(const Grid& grid, double low = 0, double scale = 1);

  /// Where voxel (i - 1, j - 1, k - 1) of the grid lies.
  [[nodiscard]] const float* at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return values_.data() + (i + j * stride_[0] + k * stride_[1]);
  }
  [[nodiscard]] const float* data() const { return values_.data(); }
  [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(values_.size()); }
  /// From a voxel to the next one along y and along z.
  [[nodiscard]] const std::array<std::int64_t, 2>& stride() const { return stride_; }

 private:
  std::array<std::int64_t, 2> stride_;
  std::vector<float> values_;
};

}  // namespace raytruth
