#include "program/completion.hpp"

#include "program/command.hpp"
#include "program/option_list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <string_view>

namespace raytruth {

namespace {

std::vector<std::string> names_of_options(const std::vector<OptionText>& options) {
  std::vector<std::string> names;
  for (const OptionText& option : options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// What bash offers behind an option that takes a value; empty: files, which the shell completes itself.
std::string offers(const OptionText& option) {
  if (!option.words.empty()) return fmt::format("compgen -W '{}'", fmt::join(option.words, " "));
  if (option.value == "DIR") return "compgen -d";
  return option.value == "FILE" ? "" : ":";
}

std::string bash_cases(const std::string& command, const std::vector<OptionText>& options) {
  std::string text;
  std::vector<std::string> words;  // of operands
  for (const OptionText& option : options) {
    if (option.names.empty()) words.insert(words.end(), option.words.begin(), option.words.end());
    if (option.names.empty() || option.value.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back(fmt::format("'{} {}'", command, name));
    const std::string offered = offers(option);
    text += fmt::format("    {}) {}return ;;\n", fmt::join(patterns, " | "),
                        offered.empty() ? "" : fmt::format("offer {}; ", offered));
  }
  const auto names = names_of_options(options);
  text += fmt::format("    '{} '*) offer compgen -W '{}{}{}' ;;\n", command, fmt::join(names, " "),
                      words.empty() ? "" : " ", fmt::join(words, " "));
  return text;
}

/// In quotes for fish.
std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result + "'";
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  std::vector<std::string> first = names_of_options(options_of(program));
  std::string cases;
  for (const Command* command : commands()) {
    first.emplace_back(command->name);
    cases += bash_cases(std::string(command->name), options_of(*program.get_subcommand(std::string(command->name))));
  }
  return fmt::format(
      R"(# Completion of raytruth for bash, as `raytruth completion bash` writes it. Where nothing is offered, files are.

_raytruth() {{
  local word=${{COMP_WORDS[COMP_CWORD]}}
  offer() {{ mapfile -t COMPREPLY < <("$@" -- "$word"); }}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    offer compgen -W '{}'
    return
  fi
  case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}  esac
}}

complete -o default -F _raytruth raytruth
)",
      fmt::join(first, " "), cases);
}

std::string zsh_completion(const CLI::App& program) {
  return "#compdef raytruth\nautoload -U +X bashcompinit && bashcompinit\n" + bash_completion(program);
}

std::string fish_completion(const CLI::App& program) {
  std::string text = "# Completion of raytruth for fish, as `raytruth completion fish` writes it.\n\n";
  for (const Command* command : commands())
    text += fmt::format("complete -c raytruth -n __fish_use_subcommand -a {} -d {}\n", command->name,
                        in_quotes(command->summary));
  for (const Command* command : commands())
    for (const OptionText& option : options_of(*program.get_subcommand(std::string(command->name)))) {
      const std::string when = fmt::format("complete -c raytruth -n '__fish_seen_subcommand_from {}'", command->name);
      const std::string words = fmt::format("{}", fmt::join(option.words, " "));
      if (option.names.empty()) {
        if (!words.empty()) text += fmt::format("{} -a {}\n", when, in_quotes(words));
        continue;
      }
      text += when;
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!words.empty())
        text += " -x -a " + in_quotes(words);
      else if (!option.value.empty())
        text += option.value == "FILE" || option.value == "DIR" ? " -r" : " -x";
      text += " -d " + in_quotes(option.summary) + "\n";
    }
  return text;
}

}  // namespace raytruth
