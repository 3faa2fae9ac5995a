#include "raytruth/textures/texture.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

float nearest_multiple(float value, float levels) {
  // In binary64 the product is exact, so that only the nearest level is chosen here.
  const double level = std::round(static_cast<double>(std::clamp(value, 0.0F, 1.0F)) * static_cast<double>(levels));
  return static_cast<float>(level / static_cast<double>(levels));
}

}  // namespace

float stored_texel(TexelType type, float value) {
  switch (type) {
    case TexelType::unorm8:
      return nearest_multiple(value, 0xFF);
    case TexelType::unorm16:
      return nearest_multiple(value, 0xFFFF);
    case TexelType::float16:
      return static_cast<float>(Eigen::half(value));
    case TexelType::float32:
      return value;
  }
  return value;
}

Texture Texture::stored(TexelFormat format) const {
  const auto [name, type, format_channels] = facts(format);
  if (format_channels != channels)
    throw InputError(
        fmt::format("a texture of {} channels as {}; formats of as many channels are allowed", channels, name));
  Texture result = *this;
  std::transform(texels.begin(), texels.end(), result.texels.begin(),
                 [kind = type](float value) { return stored_texel(kind, value); });
  return result;
}

}  // namespace raytruth
