#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace raytruth {

/// `text` as part of a one-line message: what does not print (control characters, line ends) becomes '?', and what is
/// beyond 120 characters is left out.
[[nodiscard]] std::string printable(std::string_view text);

/// Throws InputError "<file>: <found>; <allowed>", one line.
[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view found, std::string_view allowed);

}  // namespace raytruth
