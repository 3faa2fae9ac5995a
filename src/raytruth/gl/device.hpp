#pragma once

#include "raytruth/textures/texel_format.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace raytruth {

/// How an OpenGL context comes about.
enum class GlPlatform {
  osmesa,           ///< Mesa's renderer in memory
  egl,              ///< the first of the next two that comes up
  egl_device,       ///< the first of EGL's devices that has OpenGL; hardware is named before software
  egl_surfaceless,  ///< EGL's default device without a window
};

/// What renders, in its own words.
struct GlIdentity {
  std::string platform;  ///< "osmesa", "egl device" or "egl surfaceless"
  std::string vendor;
  std::string renderer;
  std::string version;
};

/// A texture of one, two or three dimensions, clamped to its edge.
struct GlTexture {
  std::vector<std::size_t> size;  ///< width, height, depth
  TexelFormat format{};
  std::span<const float> texels;  ///< one number a texel for r..., four for rgba...; x fastest
  bool is_linear = false;         ///< interpolated between the centres of texels, else the nearest
};

using GlUniform = std::variant<int, float, std::array<float, 2>, std::array<float, 3>, std::array<float, 4>>;

/// What shaders read by name.
struct GlInputs {
  std::map<std::string, GlUniform> uniforms = {};
  std::map<std::string, GlTexture> textures = {};
};

/// A compute shader of 64 x 1 x 1 invocations a group. Its buffers are std430 arrays of float: `inputs` at the bindings
/// 0, 1, ... and one for output at the next one. `uniform uint invocations` holds their number; the index of one is
///
///     gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x,
///
/// and those from `invocations` on have nothing to do.
struct ComputePass {
  std::string shader;
  GlInputs reads = {};
  std::vector<std::span<const float>> inputs = {};
  std::size_t invocations = 0;
  std::size_t output_size = 0;
};

/// A fragment shader over all pixels of an image of 32-bit floats; it writes the vec4 `layout(location = 0) out`.
struct DrawPass {
  std::string shader;
  GlInputs reads = {};
  std::size_t width = 0;
  std::size_t height = 0;
};

/// A shader that does not compile or link; the message is the compiler's.
struct ShaderError : std::logic_error {
  using std::logic_error::logic_error;
};

/// Something that renders with OpenGL 4.3 core. A pass is data: it is compiled (once for each text), run and read back,
/// and leaves nothing behind. A device may be used on any thread, but on one at a time.
class GlDevice {
 public:
  virtual ~GlDevice() = default;
  GlDevice(const GlDevice&) = delete;
  GlDevice& operator=(const GlDevice&) = delete;

  [[nodiscard]] virtual const GlIdentity& identity() const = 0;

  /// The output buffer. Throws ShaderError; MissingError for what is beyond the device.
  virtual std::vector<float> compute(const ComputePass& pass) = 0;

  /// Four numbers a pixel, the row at gl_FragCoord.y = 1/2 first. Throws as `compute` does.
  virtual std::vector<float> draw(const DrawPass& pass) = 0;

 protected:
  GlDevice() = default;
};

/// Throws MissingError, which names the package, where this build or this machine has no such context.
std::unique_ptr<GlDevice> open_gl(GlPlatform platform);

}  // namespace raytruth
