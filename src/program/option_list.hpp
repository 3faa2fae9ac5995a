#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace raytruth {

/// An option of a command as a reader sees it, or an operand, which has no names.
struct OptionText {
  std::vector<std::string> names;  ///< "-o" or "--profile"
  std::string value;               ///< how its value is called, "DIR" or an operand's name; empty: a flag
  std::vector<std::string> words;  ///< all that the value may be; empty: anything
  std::string summary;
  bool is_required = false;
  bool is_repeated = false;  ///< takes any number of values
};

/// The options of a command, or of the program itself, as it describes them to the parser.
std::vector<OptionText> options_of(const CLI::App& command);

}  // namespace raytruth
