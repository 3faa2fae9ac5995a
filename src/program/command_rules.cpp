#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/rules/shader_text.hpp"

namespace raytruth {

namespace {

struct RulesOptions {
  std::string language{shader_languages().front().name};
  std::optional<std::string> file;  ///< none: standard output
};

int write_rules(const RulesOptions& options) {
  const std::string text = shader_text(find_named(shader_languages(), options.language)->language);
  if (options.file)
    write_whole(*options.file, text);
  else
    print(text);
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<RulesOptions>();
  const auto names = names_of(shader_languages());
  std::string summary = "Of the shader";
  for (const ShaderLanguageInfo& language : shader_languages())
    summary += std::string(&language == &shader_languages().front() ? ": " : "; ") + std::string(language.name) + ", " +
               std::string(language.summary);
  add.word("--language", options->language, {names.begin(), names.end()}, summary + " (default: glsl)");
  add.text("-o", "FILE", options->file, "Write this file (default: to standard output)");
  return [options] { return write_rules(*options); };
}

}  // namespace

extern const Command rules_command;
const Command rules_command{
    .name = "rules",
    .summary = "Write the shader functions of volume rendering, for OpenGL, WebGL 2 or WebGPU",
    .example = "raytruth rules --language wgsl -o rules.wgsl",
    .notes =
        "The text is the one that C++ runs, and is pasted in front of a shader: functions alone, without state.\n"
        "What they are called, their units and their errors: src/raytruth/rules/README.md, which is installed as\n"
        "include/raytruth/rules/README.md, with examples for three.js, vtk.js, NiiVue and WebGPU.",
    .describe = describe};

}  // namespace raytruth
