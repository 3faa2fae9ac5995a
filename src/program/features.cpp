#include "program/features.hpp"

#include "raytruth/gl/platforms.hpp"
#include "raytruth/kernels/levels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace raytruth {

namespace {

#ifdef RAYTRUTH_PYTHON
constexpr bool has_python = true;
#else
constexpr bool has_python = false;
#endif

}  // namespace

std::string features() {
  const auto platforms = compiled_gl_platforms();
  return fmt::format(
      "OpenGL: {}\n"
      "Python module: {}\n"
      "x86-64 levels: {}; in use: {}",
      platforms.empty() ? "none" : fmt::format("{}", fmt::join(platforms, ", ")), has_python ? "yes" : "no",
      fmt::join(compiled_levels(), ", "), level_in_use());
}

}  // namespace raytruth
