#pragma once

#include <map>
#include <string>

namespace CLI {
class App;
}

namespace raytruth {

/// The pages of the manual in the language of `man`, by their file names: raytruth.1, and raytruth-COMMAND.1 for each.
std::map<std::string, std::string> manual_pages(const CLI::App& program);

}  // namespace raytruth
