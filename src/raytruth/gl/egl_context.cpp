#include "raytruth/core/error.hpp"
#include "raytruth/gl/context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <string>
#include <utility>

namespace raytruth {

namespace {

constexpr int most_devices = 64;

class EglContext : public GlContext {
 public:
  EglContext(EGLDisplay display, const char* platform) : display_(display), platform_(platform) {
    constexpr std::array attributes{
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    eglBindAPI(EGL_OPENGL_API);
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) throw MissingError("EGL has no OpenGL 4.3 core on this display");
  }
  ~EglContext() override { eglDestroyContext(display_, context_); }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void make_current() override {
    eglBindAPI(EGL_OPENGL_API);  // a thread's own setting
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE)
      throw MissingError("EGL cannot make an OpenGL context current without a surface");
  }

  void release() noexcept override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

  [[nodiscard]] Address find(const char* name) const override { return eglGetProcAddress(name); }

  [[nodiscard]] const char* platform() const override { return platform_; }

 private:
  EGLDisplay display_;
  const char* platform_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

template <class Function>
Function extension(const char* name) {
  const auto function = reinterpret_cast<Function>(eglGetProcAddress(name));
  if (function == nullptr) throw MissingError(std::string("EGL has no ") + name);
  return function;
}

std::unique_ptr<GlContext> make_context(EGLenum kind, void* native, const char* platform) {
  EGLDisplay display = extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT")(kind, native, nullptr);
  // A display is the process's, one for each device, so it is not ours to terminate; once initialised it stays so.
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
    throw MissingError(std::string("there is no display of ") + platform);
  return std::make_unique<EglContext>(display, platform);
}

}  // namespace

std::unique_ptr<GlContext> make_egl_device_context() {
  std::array<EGLDeviceEXT, most_devices> devices{};
  EGLint count = 0;
  extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT")(most_devices, devices.data(), &count);
  for (int i = 0; i < count; ++i) {
    try {
      return make_context(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], "egl device");
    } catch (const MissingError&) {
      continue;  // a device without OpenGL
    }
  }
  throw MissingError("none of EGL's devices has OpenGL 4.3 core; install libegl1 and a driver, as libgl1-mesa-dri");
}

std::unique_ptr<GlContext> make_egl_surfaceless_context() {
  try {
    return make_context(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "egl surfaceless");
  } catch (const MissingError& error) {
    throw MissingError(std::string(error.what()) + "; install libegl1 and a driver, as libgl1-mesa-dri");
  }
}

}  // namespace raytruth
