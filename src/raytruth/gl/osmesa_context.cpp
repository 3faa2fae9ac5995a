#include "raytruth/core/error.hpp"
#include "raytruth/gl/context.hpp"

#include <GL/osmesa.h>

#include <array>

namespace raytruth {

namespace {

class OsmesaContext : public GlContext {
 public:
  OsmesaContext() {
    constexpr std::array attributes{OSMESA_FORMAT,
                                    OSMESA_RGBA,
                                    OSMESA_PROFILE,
                                    OSMESA_CORE_PROFILE,
                                    OSMESA_CONTEXT_MAJOR_VERSION,
                                    4,
                                    OSMESA_CONTEXT_MINOR_VERSION,
                                    3,
                                    0};
    context_.reset(OSMesaCreateContextAttribs(attributes.data(), nullptr));
    if (!context_) throw MissingError("OSMesa has no OpenGL 4.3 core here; install libosmesa6 (Mesa 22 or later)");
  }

  void make_current() override {
    if (OSMesaMakeCurrent(context_.get(), pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE)
      throw MissingError("OSMesa cannot make its OpenGL context current; install libosmesa6 (Mesa 22 or later)");
  }

  void release() noexcept override { OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0); }

  [[nodiscard]] Address find(const char* name) const override { return OSMesaGetProcAddress(name); }

  [[nodiscard]] const char* platform() const override { return "osmesa"; }

 private:
  struct Destroy {
    void operator()(OSMesaContext context) const { OSMesaDestroyContext(context); }
  };
  std::unique_ptr<osmesa_context, Destroy> context_;
  std::array<unsigned char, 4> pixel_{};  // OSMesa wants a window's memory, which nothing is drawn to
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace raytruth
