#include "experiments/output.hpp"
#include "program/command.hpp"
#include "program/manual.hpp"

#include <filesystem>

namespace raytruth {

namespace {

std::function<int()> describe(CommandOptions& add) {
  const auto folder = std::make_shared<std::string>();
  add.required_text("-o", "DIR", *folder, "Write the pages into this folder");
  return [folder, &program = add.program()] {
    make_folder(*folder);
    for (const auto& [name, page] : manual_pages(program)) write_whole(std::filesystem::path(*folder) / name, page);
    return 0;
  };
}

}  // namespace

extern const Command manual_command;
const Command manual_command{.name = "manual",
                             .summary = "Write the pages of the manual, for man",
                             .example = "raytruth manual -o share/man/man1",
                             .notes = "An installed program has them already: `man raytruth`, `man raytruth-run`.",
                             .describe = describe};

}  // namespace raytruth
