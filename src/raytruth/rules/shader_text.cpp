#include "raytruth/rules/shader_text.hpp"

#include "raytruth/rules/texts.hpp"
#include "raytruth/rules/wgsl.hpp"

#include <fmt/format.h>

#include <array>

namespace raytruth {

namespace {

constexpr std::array languages{
    ShaderLanguageInfo{ShaderLanguage::glsl, "glsl", "OpenGL, from GLSL 3.30 on"},
    ShaderLanguageInfo{ShaderLanguage::essl, "essl", "OpenGL ES and WebGL 2, from GLSL ES 3.00 on"},
    ShaderLanguageInfo{ShaderLanguage::wgsl, "wgsl", "WebGPU"},
};

// What stands on top: whose text it is, where it goes, and what it cannot promise.
constexpr std::string_view head =
    "// Raytruth's rules: shader functions of volume rendering, as `raytruth rules --language {}` writes them.\n"
    "// Copyright (c) 2026, the Raytruth authors. SPDX-License-Identifier: BSD-3-Clause\n"
    "//\n"
    "{}\n";

constexpr std::string_view notes_of_glsl =
    "// Put this text behind `#version`, 330 or later, and in front of your own.\n";

constexpr std::string_view notes_of_essl =
    "// Put this text behind `#version 300 es` or later, and in front of your own. Its numbers are highp.\n"
    "\n"
    "precision highp float;\n"
    "precision highp int;\n";

constexpr std::string_view notes_of_wgsl =
    "// Put this text in front of your own, or behind it. It is a translation of the GLSL that C++ runs too.\n"
    "//\n"
    "// WGSL lets a compiler reassociate sums and fuse products, and has no `precise` to forbid it. Where one does, "
    "log1p is\n"
    "// off by up to 3 units in the last place instead of 1, and expm1 above 1 by up to one for each unit of its "
    "argument;\n"
    "// below 1, as rules of opacities call it, by 4. sine keeps its absolute error, 2^-22, but near pi no digits.\n"
    "// Infinities and NaN are what the implementation makes of them.\n";

}  // namespace

std::span<const ShaderLanguageInfo> shader_languages() { return languages; }

std::string shader_text(ShaderLanguage language) {
  const std::string rules = std::string("\n") + rule_prelude + "\n" + rule_texts;
  switch (language) {
    case ShaderLanguage::glsl:
      return fmt::format(head, "glsl", notes_of_glsl) + rules;
    case ShaderLanguage::essl:
      return fmt::format(head, "essl", notes_of_essl) + rules;
    case ShaderLanguage::wgsl:
      return fmt::format(head, "wgsl", notes_of_wgsl) + wgsl_of(rules, "the rules");
  }
  return {};
}

}  // namespace raytruth
