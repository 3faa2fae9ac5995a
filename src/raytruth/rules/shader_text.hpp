#pragma once

#include <span>
#include <string>
#include <string_view>

namespace raytruth {

/// Languages in which shaders take the rules.
enum class ShaderLanguage {
  glsl,  ///< of OpenGL, from 3.30 on
  essl,  ///< of OpenGL ES and WebGL 2, from 3.00 on
  wgsl,  ///< of WebGPU
};

struct ShaderLanguageInfo {
  ShaderLanguage language;
  std::string_view name;
  std::string_view summary;
};

/// All languages.
std::span<const ShaderLanguageInfo> shader_languages();

/// All rules with the functions that they need, to be put in front of a shader's own text: that of the .glsl files,
/// which C++ compiles too, in this language. No state, no `#version`, no entry point.
std::string shader_text(ShaderLanguage language);

}  // namespace raytruth
