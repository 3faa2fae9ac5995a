#include "raytruth/gl/device.hpp"
#include "unit/gl/on_every_gl.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace raytruth {
namespace {

class GlDeviceTest : public OnEveryGl {};
INSTANTIATE_TEST_SUITE_P(Gl, GlDeviceTest, every_gl_platform, platform_name);

constexpr const char* add_one = R"(#version 430 core
layout(local_size_x = 64) in;
uniform uint invocations;
layout(std430, binding = 0) readonly buffer Input { float numbers[]; };
layout(std430, binding = 1) writeonly buffer Output { float sums[]; };
void main() {
  uint i = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (i < invocations) sums[i] = numbers[i] + 1.0;
}
)";

std::vector<float> counted(std::size_t count) {
  std::vector<float> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0.0F);
  return numbers;
}

TEST_P(GlDeviceTest, IsSaidToBeOpenGl43OrBetter) {
  const GlIdentity& identity = device->identity();
  EXPECT_FALSE(identity.renderer.empty());
  EXPECT_GE(identity.version.substr(0, 3), "4.3");
}

TEST_P(GlDeviceTest, ComputesMoreInvocationsThanAnAxisHolds) {
  const std::vector<float> numbers = counted(65535 * 64 + 100);
  const std::vector<float> sums = device->compute(
      {.shader = add_one, .inputs = {numbers}, .invocations = numbers.size(), .output_size = numbers.size()});
  ASSERT_EQ(sums.size(), numbers.size());
  for (std::size_t i = 0; i < sums.size(); ++i) ASSERT_EQ(sums[i], numbers[i] + 1) << i;
}

TEST_P(GlDeviceTest, ComputesNothingOfNothing) {
  EXPECT_TRUE(device->compute({.shader = add_one, .inputs = {{}}}).empty());
}

TEST_P(GlDeviceTest, TakesTurnsWithAnotherOne) {
  const std::vector<float> numbers = counted(64);
  const ComputePass pass{.shader = add_one, .inputs = {numbers}, .invocations = 64, .output_size = 64};
  const auto other = open_gl(GetParam());
  const auto first = device->compute(pass);
  EXPECT_EQ(other->compute(pass), first);
  EXPECT_EQ(device->compute(pass), first);
}

TEST_P(GlDeviceTest, DrawsFloatsBeyondTheUnitInterval) {
  const auto pixels =
      device->draw({.shader = R"(#version 430 core
uniform float scale;
uniform vec3 offset;
layout(location = 0) out vec4 color;
void main() { color = vec4(scale * gl_FragCoord.xy + offset.xy, offset.z, -1e30); }
)",
                    .reads = {.uniforms = {{"scale", 2.0F}, {"offset", std::array{10.0F, 20.0F, 30.0F}}}},
                    .width = 3,
                    .height = 2});
  ASSERT_EQ(pixels.size(), 24U);
  EXPECT_EQ(pixels[0], 11);
  EXPECT_EQ(pixels[1], 21);
  EXPECT_EQ(pixels[20], 15);
  EXPECT_EQ(pixels[21], 23);
  EXPECT_EQ(pixels[22], 30);
  EXPECT_EQ(pixels[23], -1e30F);
}

TEST_P(GlDeviceTest, ReadsTexturesInEveryFormat) {
  using enum TexelFormat;
  const std::vector<float> one{0.2F};
  const std::vector<float> four{0.2F, 0.4F, 0.6F, 0.8F};
  for (const TexelFormat format : {r8, r16, r16f, r32f, rgba8, rgba16, rgba16f, rgba32f}) {
    const bool is_red = format <= r32f;
    const auto pixel = device->draw(
        {.shader = R"(#version 430 core
uniform sampler3D cube;
layout(location = 0) out vec4 color;
void main() { color = texture(cube, vec3(0.5)); }
)",
         .reads = {.textures = {{"cube", {.size = {1, 1, 1}, .format = format, .texels = is_red ? one : four}}}},
         .width = 1,
         .height = 1});
    // 0.2 = 51/255 = 13107/65535; a half float has 11 bits, and drivers may cut off the rest.
    const double tolerance = format == r16f || format == rgba16f ? 0x1p-13 : 1e-7;
    EXPECT_NEAR(pixel[0], 0.2, tolerance) << static_cast<int>(format);
    EXPECT_NEAR(pixel[2], is_red ? 0 : 0.6, 4 * tolerance) << static_cast<int>(format);
  }
}

TEST_P(GlDeviceTest, RefusesShadersThatDoNotCompile) {
  EXPECT_THROW(device->compute({.shader = "#version 430 core\nnonsense"}), ShaderError);
  EXPECT_THROW(device->draw({.shader = "#version 430 core\nvoid main() { undeclared = 1; }", .width = 1, .height = 1}),
               ShaderError);
}

TEST_P(GlDeviceTest, RefusesTexturesThatLackTexels) {
  const std::vector<float> two{1, 2};
  EXPECT_THROW(
      device->draw({.shader = R"(#version 430 core
uniform sampler2D image;
layout(location = 0) out vec4 color;
void main() { color = texture(image, vec2(0.5)); }
)",
                    .reads = {.textures = {{"image", {.size = {2, 2}, .format = TexelFormat::r8, .texels = two}}}},
                    .width = 1,
                    .height = 1}),
      std::logic_error);
}

}  // namespace
}  // namespace raytruth
