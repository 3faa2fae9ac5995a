#include "raytruth/gl/texture_look_ups.hpp"

#include "raytruth/gl/rule_shader.hpp"
#include "raytruth/gl/texts.hpp"

#include <fmt/format.h>

#include <cmath>

namespace raytruth {

GlTexture for_sampling(const Texture& texture, TexelFormat format) {
  const auto end = texture.size.begin() + static_cast<std::ptrdiff_t>(texture.dimensions);
  return {.size = {texture.size.begin(), end}, .format = format, .texels = texture.texels, .is_linear = true};
}

std::vector<float> look_up_in_shader(GlDevice& device, const Texture& texture, TexelFormat format,
                                     std::span<const float> coordinates, const ShaderFilter& filter) {
  const std::size_t count = coordinates.size() / texture.dimensions;
  return device.compute(
      {.shader =
           rule_shader(fmt::format("#define DIMENSIONS {}\n{}{}", texture.dimensions, texture_unit, texture_look_ups)),
       .reads = {.uniforms = {{"is_emulated", filter.is_emulated ? 1 : 0},
                              {"levels", filter.weight_bits > 0 ? std::ldexp(1.0F, filter.weight_bits) : 0.0F}},
                 .textures = {{"looked_up", for_sampling(texture, format)}}},
       .inputs = {coordinates},
       .invocations = count,
       .output_size = 4 * count});
}

}  // namespace raytruth
