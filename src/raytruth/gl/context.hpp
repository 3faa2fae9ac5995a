#pragma once

#include <memory>

namespace raytruth {

/// An OpenGL context of at least 4.3 core, current on no thread but between `make_current` and `release`.
class GlContext {
 public:
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  virtual void make_current() = 0;
  virtual void release() noexcept = 0;

  using Address = void (*)();
  /// A function of OpenGL by its name; null if there is none.
  [[nodiscard]] virtual Address find(const char* name) const = 0;

  [[nodiscard]] virtual const char* platform() const = 0;

 protected:
  GlContext() = default;
};

// Each exists where its library was there when this was built, and throws MissingError where no context comes up.

std::unique_ptr<GlContext> make_osmesa_context();
std::unique_ptr<GlContext> make_egl_device_context();
std::unique_ptr<GlContext> make_egl_surfaceless_context();

}  // namespace raytruth
