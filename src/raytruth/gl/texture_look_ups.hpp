#pragma once

#include "raytruth/gl/device.hpp"
#include "raytruth/textures/texture.hpp"

#include <span>
#include <vector>

namespace raytruth {

/// The texture as a shader's sampler reads it, linearly filtered; the texels must outlive it.
GlTexture for_sampling(const Texture& texture, TexelFormat format);

/// Who filters a texture that a shader looks up.
struct ShaderFilter {
  bool is_emulated = false;  ///< textures/texture_unit.glsl; else the device's own sampler
  int weight_bits = 0;       ///< of the emulation; 0: as exact as a float
};

/// Looks the texture up, kept in this format, at normalised `coordinates`, those of one look-up side by side: linearly
/// filtered, clamped to the edge. Four numbers for each look-up. Throws MissingError for what is beyond the device.
std::vector<float> look_up_in_shader(GlDevice& device, const Texture& texture, TexelFormat format,
                                     std::span<const float> coordinates, const ShaderFilter& filter);

}  // namespace raytruth
