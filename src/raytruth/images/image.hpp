#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// More pixels than this along a side are refused.
inline constexpr std::int64_t largest_image_side = 65536;

/// Pixels of linear light over black, with their opacity in the fourth channel; row 0 is the topmost.
struct Image {
  explicit Image(const std::array<std::int64_t, 2>& width_and_height)
      : size(width_and_height), pixels(static_cast<std::size_t>(size[0] * size[1]), Eigen::Array4d::Zero()) {}

  [[nodiscard]] Eigen::Array4d& at(std::int64_t column, std::int64_t row) {
    return pixels[static_cast<std::size_t>(row * size[0] + column)];
  }

  std::array<std::int64_t, 2> size;  ///< width and height
  std::vector<Eigen::Array4d> pixels;
};

}  // namespace raytruth
