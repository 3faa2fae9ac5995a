#include "experiments/output.hpp"
#include "program/command.hpp"
#include "program/completion.hpp"

namespace raytruth {

namespace {

struct CompletionOptions {
  std::string shell = "bash";
  std::optional<std::string> file;  ///< none: standard output
};

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<CompletionOptions>();
  add.optional_operand("shell", options->shell, {"bash", "zsh", "fish"}, "Of this shell (default: bash)");
  add.text("-o", "FILE", options->file, "Write this file (default: to standard output)");
  return [options, &program = add.program()] {
    const std::string& shell = options->shell;
    const std::string text = shell == "fish"  ? fish_completion(program)
                             : shell == "zsh" ? zsh_completion(program)
                                              : bash_completion(program);
    if (options->file)
      write_whole(*options->file, text);
    else
      print(text);
    return 0;
  };
}

}  // namespace

extern const Command completion_command;
const Command completion_command{.name = "completion",
                                 .summary = "Write a script that completes command lines, for bash, zsh or fish",
                                 .example = "source <(raytruth completion bash)",
                                 .notes = "An installed program has them already.",
                                 .describe = describe};

}  // namespace raytruth
