#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace raytruth {

/// How texels are stored: their channels and the type of each.
enum class TexelFormat { r8, r16, r16f, r32f, rgba8, rgba16, rgba16f, rgba32f };

/// How a texture stores a component of a texel.
enum class TexelType {
  unorm8,   ///< of [0, 1] the multiples of 1 / 255
  unorm16,  ///< and of 1 / 65535
  float16,
  float32,
};

struct TexelFormatFacts {
  std::string_view name;  ///< as OpenGL has it
  TexelType type;
  std::size_t channels;
};

[[nodiscard]] constexpr TexelFormatFacts facts(TexelFormat format) {
  constexpr std::array<TexelFormatFacts, 8> table{{{"R8", TexelType::unorm8, 1},
                                                   {"R16", TexelType::unorm16, 1},
                                                   {"R16F", TexelType::float16, 1},
                                                   {"R32F", TexelType::float32, 1},
                                                   {"RGBA8", TexelType::unorm8, 4},
                                                   {"RGBA16", TexelType::unorm16, 4},
                                                   {"RGBA16F", TexelType::float16, 4},
                                                   {"RGBA32F", TexelType::float32, 4}}};
  return table[static_cast<std::size_t>(format)];
}

/// The number of this type that is nearest to `value`: for the fixed-point ones clamped to [0, 1], as OpenGL 4.5 core,
/// section 2.3.5.2, prefers it; halves to even for float16.
float stored_texel(TexelType type, float value);

/// The largest difference of `stored_texel` from numbers of magnitude up to 1, in [0, 1] for the fixed-point types.
[[nodiscard]] constexpr double largest_texel_error(TexelType type) {
  switch (type) {
    case TexelType::unorm8:
      return 0.5 / 0xFF;
    case TexelType::unorm16:
      return 0.5 / 0xFFFF;
    case TexelType::float16:
      return 0x1p-12;
    default:
      return 0;
  }
}

}  // namespace raytruth
