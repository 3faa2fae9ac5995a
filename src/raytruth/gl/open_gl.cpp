#include "raytruth/core/error.hpp"
#include "raytruth/gl/device.hpp"
#include "raytruth/gl/passes.hpp"
#include "raytruth/gl/platforms.hpp"

namespace raytruth {

std::vector<std::string_view> compiled_gl_platforms() {
  return {
#ifdef RAYTRUTH_OSMESA
      "osmesa",
#endif
#ifdef RAYTRUTH_EGL
      "egl",
#endif
  };
}

std::unique_ptr<GlDevice> open_gl(GlPlatform platform) {
  switch (platform) {
#ifdef RAYTRUTH_OSMESA
    case GlPlatform::osmesa:
      return make_passes(make_osmesa_context());
#endif
#ifdef RAYTRUTH_EGL
    case GlPlatform::egl:
      try {
        return open_gl(GlPlatform::egl_device);
      } catch (const MissingError&) {
        return open_gl(GlPlatform::egl_surfaceless);
      }
    case GlPlatform::egl_device:
      return make_passes(make_egl_device_context());
    case GlPlatform::egl_surfaceless:
      return make_passes(make_egl_surfaceless_context());
#endif
    default:
      break;
  }
  throw MissingError(platform == GlPlatform::osmesa
                         ? "this program was built without OSMesa; install libosmesa6-dev and build it again"
                         : "this program was built without EGL; install libegl-dev and build it again");
}

}  // namespace raytruth
