#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace raytruth {

/// `text` as part of a message: on one line, and at most 120 bytes of it.
[[nodiscard]] inline std::string printable(std::string_view text) {
  constexpr std::size_t longest = 120;
  return shortened(one_line(text), longest);
}

/// Throws InputError "<file>: <found>; <allowed>", one line.
[[noreturn]] inline void refuse(const std::filesystem::path& file, std::string_view found, std::string_view allowed) {
  throw InputError(one_line(fmt::format("{}: {}; {}", file.string(), found, allowed)));
}

}  // namespace raytruth
