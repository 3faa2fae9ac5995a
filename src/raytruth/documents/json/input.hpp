#pragma once

#include <string>
#include <string_view>

namespace raytruth {

/// How messages name a file; "-" is standard input.
std::string input_name(const std::string& path);

/// All of a file; "-" is standard input. `what` is what a message says is allowed: "a readable JSON file". Throws
/// InputError for what cannot be read, and for more than 1 GiB.
std::string read_text(const std::string& path, std::string_view what);

}  // namespace raytruth
