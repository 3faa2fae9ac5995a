#pragma once

#include "raytruth/textures/texel_format.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// Numbers that a texture unit reads, on a grid of one to three dimensions.
struct Texture {
  std::array<std::int64_t, 3> size{1, 1, 1};  ///< 1 along axes that it does not have
  std::size_t dimensions = 1;
  std::size_t channels = 1;        ///< 1 or 4
  std::vector<float> texels = {};  ///< x fastest, channels of a texel side by side

  /// The texture as this format keeps it. Throws InputError for a format of another number of channels.
  [[nodiscard]] Texture stored(TexelFormat format) const;
};

}  // namespace raytruth
