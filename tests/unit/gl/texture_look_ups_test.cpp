#include "raytruth/gl/texture_look_ups.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/textures/texture_unit.hpp"
#include "unit/gl/on_every_gl.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace raytruth {
namespace {

class TextureLookUps : public OnEveryGl {};

float random(std::uint64_t index) { return static_cast<float>(random_numbers(5, RandomStream::points, index)[0]); }

/// A texture of numbers in [0, 1), or of zeros and ones, which every format keeps as they are.
Texture random_texture(std::size_t dimensions, std::size_t channels, bool is_binary) {
  Texture texture{.dimensions = dimensions, .channels = channels};
  const std::array<std::int64_t, 3> sides{13, 7, 5};
  std::size_t count = channels;
  for (std::size_t axis = 0; axis < dimensions; ++axis) {
    texture.size[axis] = sides[axis];
    count *= static_cast<std::size_t>(sides[axis]);
  }
  for (std::size_t i = 0; i < count; ++i) texture.texels.push_back(is_binary ? std::round(random(i)) : random(i));
  return texture;
}

/// Beyond the edges too.
std::vector<float> random_coordinates(std::size_t dimensions) {
  std::vector<float> coordinates;
  for (std::size_t i = 0; i < 1000 * dimensions; ++i) coordinates.push_back(1.25F * random(i) - 0.125F);
  return coordinates;
}

/// The largest difference of a shader's look-ups from those of a unit.
template <class Real>
double largest_difference(const std::vector<float>& found, const TextureUnit<Real>& unit,
                          const std::vector<float>& coordinates, std::size_t dimensions) {
  double largest = 0;
  for (std::size_t i = 0; i < coordinates.size() / dimensions; ++i) {
    std::array<Real, 3> coordinate{};
    for (std::size_t axis = 0; axis < dimensions; ++axis)
      coordinate[axis] = Real(static_cast<double>(coordinates[dimensions * i + axis]));
    const auto expected = unit.linear(coordinate);
    for (std::size_t channel = 0; channel < 4; ++channel)
      largest = std::max(largest, std::abs(static_cast<double>(found[4 * i + channel]) -
                                           to_double(expected[static_cast<Eigen::Index>(channel)])));
  }
  return largest;
}

constexpr std::array formats{TexelFormat::r8,    TexelFormat::r16,    TexelFormat::r16f,    TexelFormat::r32f,
                             TexelFormat::rgba8, TexelFormat::rgba16, TexelFormat::rgba16f, TexelFormat::rgba32f};

TEST_P(TextureLookUps, EmulationIsThatOfTheCpu) {
  for (const std::size_t dimensions : {1, 2, 3})
    for (const TexelFormat format : formats)
      for (const int weight_bits : {0, 6, 8, 16}) {
        SCOPED_TRACE(testing::Message() << dimensions << "D, " << facts(format).name << ", " << weight_bits);
        const Texture texture = random_texture(dimensions, facts(format).channels, true);
        const auto coordinates = random_coordinates(dimensions);
        const auto found =
            look_up_in_shader(*device, texture, format, coordinates, {.is_emulated = true, .weight_bits = weight_bits});
        // Both do the same operations on the same numbers; where a compiler contracts them, they differ by a few ulps
        // of 1.
        EXPECT_LE(largest_difference(found, TextureUnit<Binary32>(texture, weight_bits), coordinates, dimensions),
                  0x1p-22);
      }
}

TEST_P(TextureLookUps, FormatsStoreOneOfTheTwoNearestNumbers) {
  for (const TexelFormat format : formats) {
    SCOPED_TRACE(facts(format).name);
    const Texture texture = random_texture(1, facts(format).channels, false);
    std::vector<float> centres;
    for (std::int64_t i = 0; i < texture.size[0]; ++i)
      centres.push_back((static_cast<float>(i) + 0.5F) / static_cast<float>(texture.size[0]));
    const auto found = look_up_in_shader(*device, texture, format, centres, {.is_emulated = true, .weight_bits = 6});
    // OpenGL prefers the nearest, but does not ask for it: Mesa cuts RGBA16F off.
    EXPECT_LE(largest_difference(found, TextureUnit<double>(texture, 6), centres, 1),
              2 * largest_texel_error(facts(format).type) + 0x1p-24);
  }
}

TEST_P(TextureLookUps, SamplerFiltersFloatsAsTheCpuDoes) {
  for (const std::size_t dimensions : {1, 2, 3}) {
    const Texture texture = random_texture(dimensions, 4, false);
    const auto coordinates = random_coordinates(dimensions);
    const auto found = look_up_in_shader(*device, texture, TexelFormat::rgba32f, coordinates, {});
    const double difference = largest_difference(found, TextureUnit<double>(texture), coordinates, dimensions);
    // Hardware has at least 8 bits of weight on every axis; no sampler may be worse.
    EXPECT_LE(difference, static_cast<double>(dimensions) * 0x1p-9 + 0x1p-20);
  }
}

INSTANTIATE_TEST_SUITE_P(Gl, TextureLookUps, every_gl_platform, platform_name);

}  // namespace
}  // namespace raytruth
