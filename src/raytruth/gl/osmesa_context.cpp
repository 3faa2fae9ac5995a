#include "raytruth/core/error.hpp"
#include "raytruth/gl/context.hpp"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <string>

namespace raytruth {

namespace {

/// The functions of the library, which is loaded with the first context: with its compiler it is more than a hundred
/// megabytes, and if it were linked every start of a program would wait for them.
struct Osmesa {
  decltype(&OSMesaCreateContextAttribs) create_context;
  decltype(&OSMesaDestroyContext) destroy_context;
  decltype(&OSMesaMakeCurrent) make_current;
  decltype(&OSMesaGetProcAddress) find;
};

template <class Function>
void find_in(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr)
    throw MissingError(std::string("OSMesa has no ") + name + "; install libosmesa6 (Mesa 22 or later)");
}

const Osmesa& osmesa() {
  static const Osmesa functions = [] {
    void* const library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);  // stays until the program ends
    if (library == nullptr) throw MissingError("OSMesa is not there; install libosmesa6 (Mesa 22 or later)");
    Osmesa found{};
    find_in(library, "OSMesaCreateContextAttribs", found.create_context);
    find_in(library, "OSMesaDestroyContext", found.destroy_context);
    find_in(library, "OSMesaMakeCurrent", found.make_current);
    find_in(library, "OSMesaGetProcAddress", found.find);
    return found;
  }();
  return functions;
}

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
    context_.reset(osmesa().create_context(attributes.data(), nullptr));
    if (!context_) throw MissingError("OSMesa has no OpenGL 4.3 core here; install libosmesa6 (Mesa 22 or later)");
  }

  void make_current() override {
    if (osmesa().make_current(context_.get(), pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE)
      throw MissingError("OSMesa cannot make its OpenGL context current; install libosmesa6 (Mesa 22 or later)");
  }

  void release() noexcept override { osmesa().make_current(nullptr, nullptr, 0, 0, 0); }

  [[nodiscard]] Address find(const char* name) const override { return osmesa().find(name); }

  [[nodiscard]] const char* platform() const override { return "osmesa"; }

 private:
  struct Destroy {
    void operator()(OSMesaContext context) const { osmesa().destroy_context(context); }
  };
  std::unique_ptr<osmesa_context, Destroy> context_;
  std::array<unsigned char, 4> pixel_{};  // OSMesa wants a window's memory, which nothing is drawn to
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace raytruth
