#pragma once

#include <string>

namespace CLI {
class App;
}

namespace raytruth {

/// Scripts that complete command lines of this program: commands, options, the words that a value may be, and files.

std::string bash_completion(const CLI::App& program);
std::string zsh_completion(const CLI::App& program);
std::string fish_completion(const CLI::App& program);

}  // namespace raytruth
