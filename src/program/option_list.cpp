#include "program/option_list.hpp"

#include <CLI/CLI.hpp>

#include <sstream>

namespace raytruth {

namespace {

/// The words of "NAME:{one,other}", as a validator of words describes itself.
std::vector<std::string> words_of(const std::string& type) {
  std::vector<std::string> words;
  const auto begin = type.find('{');
  if (begin == std::string::npos) return words;
  std::istringstream list(type.substr(begin + 1, type.find('}') - begin - 1));
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

}  // namespace

std::vector<OptionText> options_of(const CLI::App& command) {
  std::vector<OptionText> options;
  for (const CLI::Option* option : command.get_options()) {
    OptionText text;
    text.summary = option->get_description();
    text.is_required = option->get_required();
    text.is_repeated = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
    for (const std::string& name : option->get_snames()) text.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) text.names.push_back("--" + name);
    const std::string type = option->get_type_name();
    if (option->get_positional())
      text.value = option->get_name(true, false);
    else if (option->get_type_size() != 0)
      text.value = type.substr(0, type.find(':'));
    text.words = words_of(type);
    options.push_back(std::move(text));
  }
  return options;
}

}  // namespace raytruth
