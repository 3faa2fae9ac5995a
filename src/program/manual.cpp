#include "program/manual.hpp"

#include "experiments/version.hpp"
#include "program/command.hpp"
#include "program/option_list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

namespace raytruth {

namespace {

/// A text that `man` shows as it is: its own signs are escaped, and line breaks are spaces.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else if (c == '\n')
      result += ' ';
    else
      result += c;
  }
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string section(std::string_view title) { return fmt::format(".SH {}\n", title); }

std::string example(std::string_view text) { return fmt::format(".EX\n{}\n.EE\n", escaped(text)); }

/// Paragraphs, which are filled, and indented lines, which are not.
std::string paragraphs(std::string_view text) {
  std::string result;
  std::istringstream lines{std::string(text)};
  bool is_indented = false;
  bool is_new = false;
  for (std::string line; std::getline(lines, line);) {
    const bool now = line.starts_with(' ');
    if (is_indented && !now) result += ".EE\n";
    if (!line.empty()) {
      if (is_new || now != is_indented) result += ".PP\n";
      if (now && !is_indented) result += ".EX\n";
      result += escaped(line) + "\n";
    }
    is_new = line.empty();
    is_indented = now;
  }
  return result + (is_indented ? ".EE\n" : "");
}

std::string heading(std::string name, std::string_view summary) {
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH {} 1 \"{}\" \"Raytruth {}\" \"Raytruth\"\n{}{} \\- {}\n", escaped(title), commit_date,
                     version, section("NAME"), escaped(name), escaped(summary));
}

std::string option_entry(const OptionText& option) {
  std::string text = ".TP\n";
  if (option.names.empty())
    return text + fmt::format("\\fI{}\\fR\n{}\n", escaped(option.value), escaped(option.summary));
  text += fmt::format("\\fB{}\\fR", escaped(fmt::format("{}", fmt::join(option.names, ", "))));
  if (!option.words.empty())
    text += " " + escaped(fmt::format("{}", fmt::join(option.words, "|")));
  else if (!option.value.empty())
    text += fmt::format(" \\fI{}\\fR", escaped(option.value));
  return text + fmt::format("\n{}{}\n", escaped(option.summary), option.is_required ? " (required)" : "");
}

std::string synopsis_of(const std::string& command, const std::vector<OptionText>& options) {
  std::string text = fmt::format("\\fBraytruth {}\\fR [\\fIoptions\\fR]", escaped(command));
  for (const OptionText& option : options) {
    std::string shown = fmt::format("\\fI{}\\fR", escaped(option.value));
    if (option.is_repeated) shown += " ...";
    if (!option.names.empty()) {
      if (option.is_required) text += fmt::format(" \\fB{}\\fR {}", escaped(option.names.front()), shown);
    } else {
      text += option.is_required ? " " + shown : fmt::format(" [{}]", shown);
    }
  }
  return text + "\n";
}

std::string exit_section() {
  std::string text = section("EXIT STATUS");
  for (const std::string_view code : exit_codes)
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", code.substr(0, 1), escaped(code.substr(2)));
  return text;
}

std::string environment_section() {
  return section("ENVIRONMENT") +
         ".TP\n\\fBRAYTRUTH_DATA\\fR\nFolders of volumes, separated by ':', which are found there by their names.\n"
         ".TP\n\\fBRAYTRUTH_MEMORY_LIMIT\\fR\nThe same as \\fB\\-\\-memory\\-limit\\fR.\n";
}

std::string command_page(const Command& command, const CLI::App& described) {
  const std::string name(command.name);
  const auto options = options_of(described);
  std::string text = heading("raytruth-" + name, command.summary) + section("SYNOPSIS") + synopsis_of(name, options);
  if (!command.notes.empty()) text += section("DESCRIPTION") + paragraphs(command.notes);
  text += section("OPTIONS");
  for (const OptionText& option : options) text += option_entry(option);
  return text + exit_section() + section("EXAMPLE") + example(command.example) + section("SEE ALSO") +
         "\\fBraytruth\\fR(1)\n";
}

std::string program_page(const CLI::App& program) {
  std::string text = heading("raytruth", program.get_description()) + section("SYNOPSIS") +
                     "\\fBraytruth\\fR \\fIcommand\\fR [\\fIoptions\\fR]\n" + section("COMMANDS");
  for (const Command* command : commands())
    text += fmt::format(".TP\n\\fBraytruth\\-{}\\fR(1)\n{}\n", escaped(command->name), escaped(command->summary));
  text += section("OPTIONS");
  for (const OptionText& option : options_of(program)) text += option_entry(option);
  return text + exit_section() + environment_section();
}

}  // namespace

std::map<std::string, std::string> manual_pages(const CLI::App& program) {
  std::map<std::string, std::string> pages{{"raytruth.1", program_page(program)}};
  for (const Command* command : commands())
    pages[fmt::format("raytruth-{}.1", command->name)] =
        command_page(*command, *program.get_subcommand(std::string(command->name)));
  return pages;
}

}  // namespace raytruth
