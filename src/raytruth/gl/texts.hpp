#pragma once

namespace raytruth {

/// Texts of shaders, which the build puts into the program as they are.

extern const char* const sampled_march;     ///< of src/raytruth/gl/sampled_march.glsl
extern const char* const texture_unit;      ///< of src/raytruth/textures/texture_unit.glsl
extern const char* const texture_look_ups;  ///< of src/raytruth/gl/texture_look_ups.glsl
extern const char* const table_builds;      ///< of src/raytruth/gl/table_builds.glsl
extern const char* const renderer_shader;   ///< of src/raytruth/gl/hand_written_renderer.frag

}  // namespace raytruth
