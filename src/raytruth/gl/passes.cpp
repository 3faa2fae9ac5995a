#include "raytruth/gl/passes.hpp"

#include "raytruth/gl/functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace raytruth {

namespace {

constexpr std::size_t group_size = 64;
constexpr std::size_t most_groups = 65535;  // along an axis, of every OpenGL

/// A triangle that covers the image.
constexpr std::string_view vertex_shader = R"(#version 430 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

/// A context is current for as long as this lives.
class Current {
 public:
  explicit Current(GlContext& context) : context_(context) { context_.make_current(); }
  ~Current() { context_.release(); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

 private:
  GlContext& context_;
};

/// A buffer, texture, framebuffer or vertex array.
class Object {
 public:
  Object(PFNGLGENBUFFERSPROC generate, PFNGLDELETEBUFFERSPROC destroy) : destroy_(destroy) { generate(1, &name_); }
  ~Object() {
    if (name_ != 0) destroy_(1, &name_);
  }
  Object(Object&& other) noexcept : destroy_(other.destroy_), name_(std::exchange(other.name_, 0)) {}
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  Object& operator=(Object&&) = delete;

  [[nodiscard]] GLuint name() const { return name_; }

 private:
  PFNGLDELETEBUFFERSPROC destroy_;
  GLuint name_ = 0;
};

struct StoredFormat {
  GLint internal;
  GLenum channels;
};

StoredFormat stored(TexelFormat format) {
  switch (format) {
    case TexelFormat::r8:
      return {GL_R8, GL_RED};
    case TexelFormat::r16:
      return {GL_R16, GL_RED};
    case TexelFormat::r16f:
      return {GL_R16F, GL_RED};
    case TexelFormat::r32f:
      return {GL_R32F, GL_RED};
    case TexelFormat::rgba8:
      return {GL_RGBA8, GL_RGBA};
    case TexelFormat::rgba16:
      return {GL_RGBA16, GL_RGBA};
    case TexelFormat::rgba16f:
      return {GL_RGBA16F, GL_RGBA};
    case TexelFormat::rgba32f:
      break;
  }
  return {GL_RGBA32F, GL_RGBA};
}

class Passes : public GlDevice {
 public:
  explicit Passes(std::unique_ptr<GlContext> context)
      : context_(std::move(context)), current_(std::in_place, *context_), gl_(*context_) {
    const auto text = [this](GLenum name) -> std::string {
      const GLubyte* const found = gl_.get_string(name);
      return found == nullptr ? "" : reinterpret_cast<const char*>(found);
    };
    identity_ = {context_->platform(), text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION)};
    gl_.pixel_store(GL_UNPACK_ALIGNMENT, 1);
    gl_.pixel_store(GL_PACK_ALIGNMENT, 1);
    current_.reset();
  }

  ~Passes() override {
    const Current current(*context_);
    for (const auto& program : programs_) gl_.delete_program(program.second);
  }
  Passes(const Passes&) = delete;
  Passes& operator=(const Passes&) = delete;

  [[nodiscard]] const GlIdentity& identity() const override { return identity_; }

  std::vector<float> compute(const ComputePass& pass) override {
    const Current current(*context_);
    const GLuint program = use({{GL_COMPUTE_SHADER, pass.shader}});
    const std::vector<Object> textures = bind(program, pass.reads);
    gl_.uniform_1ui(location(program, "invocations"), static_cast<GLuint>(pass.invocations));

    std::vector<Object> buffers;
    const auto add_buffer = [&](std::size_t count, const float* data, GLenum usage) {
      const Object& buffer = buffers.emplace_back(gl_.gen_buffers, gl_.delete_buffers);
      gl_.bind_buffer_base(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(buffers.size() - 1), buffer.name());
      gl_.buffer_data(GL_SHADER_STORAGE_BUFFER, bytes(count), data, usage);
    };
    for (const auto& input : pass.inputs) add_buffer(input.size(), input.data(), GL_STATIC_DRAW);
    add_buffer(pass.output_size, nullptr, GL_STREAM_READ);

    const std::size_t groups = (pass.invocations + group_size - 1) / group_size;
    const std::size_t columns = std::min(groups, most_groups);
    const std::size_t rows = columns == 0 ? 0 : (groups + columns - 1) / columns;
    if (rows > most_groups) throw MissingError(fmt::format("{} invocations are beyond OpenGL", pass.invocations));
    gl_.dispatch_compute(static_cast<GLuint>(columns), static_cast<GLuint>(rows), 1);
    gl_.memory_barrier(GL_BUFFER_UPDATE_BARRIER_BIT);

    std::vector<float> output(pass.output_size);
    gl_.get_buffer_sub_data(GL_SHADER_STORAGE_BUFFER, 0, bytes(output.size()), output.data());
    check("compute");
    return output;
  }

  std::vector<float> draw(const DrawPass& pass) override {
    const Current current(*context_);
    const GLuint program = use({{GL_VERTEX_SHADER, std::string(vertex_shader)}, {GL_FRAGMENT_SHADER, pass.shader}});
    const auto width = static_cast<GLsizei>(pass.width);
    const auto height = static_cast<GLsizei>(pass.height);

    const Object image(gl_.gen_textures, gl_.delete_textures);
    gl_.bind_texture(GL_TEXTURE_2D, image.name());
    gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
    const Object target(gl_.gen_framebuffers, gl_.delete_framebuffers);
    gl_.bind_framebuffer(GL_FRAMEBUFFER, target.name());
    gl_.framebuffer_texture_2d(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, image.name(), 0);
    if (gl_.check_framebuffer_status(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw MissingError(
          fmt::format("{} cannot draw to an image of {} x {} floats", identity_.renderer, pass.width, pass.height));

    const std::vector<Object> textures = bind(program, pass.reads);
    const Object vertices(gl_.gen_vertex_arrays, gl_.delete_vertex_arrays);
    gl_.bind_vertex_array(vertices.name());
    gl_.viewport(0, 0, width, height);
    gl_.draw_arrays(GL_TRIANGLES, 0, 3);

    std::vector<float> pixels(4 * pass.width * pass.height);
    gl_.read_pixels(0, 0, width, height, GL_RGBA, GL_FLOAT, pixels.data());
    check("draw");
    return pixels;
  }

 private:
  using Shaders = std::vector<std::pair<GLenum, std::string>>;

  static GLsizeiptr bytes(std::size_t count) { return static_cast<GLsizeiptr>(count * sizeof(float)); }

  GLint location(GLuint program, const std::string& name) const {
    return gl_.get_uniform_location(program, name.c_str());
  }

  GLuint use(const Shaders& shaders) {
    auto found = programs_.find(shaders.back().second);
    if (found == programs_.end()) found = programs_.emplace(shaders.back().second, link(shaders)).first;
    gl_.use_program(found->second);
    return found->second;
  }

  [[nodiscard]] GLuint link(const Shaders& shaders) const {
    const GLuint program = gl_.create_program();
    try {
      for (const auto& [stage, text] : shaders) attach(program, stage, text);
      gl_.link_program(program);
      GLint is_linked = GL_FALSE;
      gl_.get_program(program, GL_LINK_STATUS, &is_linked);
      if (is_linked == GL_FALSE) throw ShaderError(log(program, gl_.get_program, gl_.get_program_info_log));
    } catch (...) {
      gl_.delete_program(program);
      throw;
    }
    return program;
  }

  void attach(GLuint program, GLenum stage, const std::string& text) const {
    const GLuint shader = gl_.create_shader(stage);
    const char* const start = text.c_str();
    gl_.shader_source(shader, 1, &start, nullptr);
    gl_.compile_shader(shader);
    gl_.attach_shader(program, shader);
    gl_.delete_shader(shader);  // lives as long as the program
    GLint is_compiled = GL_FALSE;
    gl_.get_shader(shader, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled == GL_FALSE) throw ShaderError(log(shader, gl_.get_shader, gl_.get_shader_info_log));
  }

  static std::string log(GLuint name, PFNGLGETSHADERIVPROC get, PFNGLGETSHADERINFOLOGPROC get_log) {
    GLint length = 0;
    get(name, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<std::size_t>(length), '\0');
    get_log(name, length, &length, text.data());
    text.resize(static_cast<std::size_t>(length));
    return text;
  }

  /// Sets uniforms and textures; the textures live as long as what is returned.
  std::vector<Object> bind(GLuint program, const GlInputs& reads) const {
    for (const auto& [name, value] : reads.uniforms)
      std::visit([this, where = location(program, name)](const auto& number) { set(where, number); }, value);
    std::vector<Object> textures;
    for (const auto& [name, texture] : reads.textures) {
      const auto unit = static_cast<GLint>(textures.size());
      gl_.active_texture(GL_TEXTURE0 + static_cast<GLenum>(unit));
      upload(textures.emplace_back(gl_.gen_textures, gl_.delete_textures), texture);
      gl_.uniform_1i(location(program, name), unit);
    }
    return textures;
  }

  void set(GLint where, int value) const { gl_.uniform_1i(where, value); }
  void set(GLint where, float value) const { gl_.uniform_1f(where, value); }
  void set(GLint where, const std::array<float, 2>& value) const { gl_.uniform_2fv(where, 1, value.data()); }
  void set(GLint where, const std::array<float, 3>& value) const { gl_.uniform_3fv(where, 1, value.data()); }
  void set(GLint where, const std::array<float, 4>& value) const { gl_.uniform_4fv(where, 1, value.data()); }

  void upload(const Object& object, const GlTexture& texture) const {
    constexpr std::array<GLenum, 3> targets{GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D};
    constexpr std::array<GLenum, 3> wraps{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R};
    const auto [internal, channels] = stored(texture.format);
    std::size_t count = channels == GL_RED ? 1 : 4;
    std::array<GLsizei, 3> size{};
    for (std::size_t axis = 0; axis < texture.size.size(); ++axis) {
      size.at(axis) = static_cast<GLsizei>(texture.size[axis]);
      count *= texture.size[axis];
    }
    if (texture.size.empty() || count != texture.texels.size())
      throw std::logic_error(fmt::format("a texture of {} numbers has {}", count, texture.texels.size()));

    const GLenum target = targets.at(texture.size.size() - 1);
    const auto [width, height, depth] = size;
    const float* const texels = texture.texels.data();
    gl_.bind_texture(target, object.name());
    if (target == GL_TEXTURE_1D) gl_.tex_image_1d(target, 0, internal, width, 0, channels, GL_FLOAT, texels);
    if (target == GL_TEXTURE_2D) gl_.tex_image_2d(target, 0, internal, width, height, 0, channels, GL_FLOAT, texels);
    if (target == GL_TEXTURE_3D)
      gl_.tex_image_3d(target, 0, internal, width, height, depth, 0, channels, GL_FLOAT, texels);
    const GLint filter = texture.is_linear ? GL_LINEAR : GL_NEAREST;
    gl_.tex_parameter(target, GL_TEXTURE_MIN_FILTER, filter);
    gl_.tex_parameter(target, GL_TEXTURE_MAG_FILTER, filter);
    for (const GLenum wrap : wraps) gl_.tex_parameter(target, wrap, GL_CLAMP_TO_EDGE);
  }

  void check(const char* what) const {
    const GLenum error = gl_.get_error();
    if (error != GL_NO_ERROR)
      throw MissingError(fmt::format("{} cannot {} this: OpenGL error {:#06x}", identity_.renderer, what, error));
  }

  std::unique_ptr<GlContext> context_;
  std::optional<Current> current_;  // while functions are loaded
  GlFunctions gl_;
  GlIdentity identity_;
  std::map<std::string, GLuint> programs_;  ///< by the text of their last shader
};

}  // namespace

std::unique_ptr<GlDevice> make_passes(std::unique_ptr<GlContext> context) {
  return std::make_unique<Passes>(std::move(context));
}

}  // namespace raytruth
