#include "raytruth/volume/files/refuse.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "raytruth/core/error.hpp"

namespace raytruth {
namespace {

std::string on_one_line(std::string_view text) {
  std::string line(text);
  const auto is_control = [](char character) { return static_cast<unsigned char>(character) < 32 || character == 127; };
  std::replace_if(line.begin(), line.end(), is_control, '?');
  return line;
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::size_t longest = 120;
  return on_one_line(text.substr(0, longest)) + (text.size() > longest ? "..." : "");
}

void refuse(const std::filesystem::path& file, std::string_view found, std::string_view allowed) {
  throw InputError(on_one_line(fmt::format("{}: {}; {}", file.string(), found, allowed)));
}

}  // namespace raytruth
