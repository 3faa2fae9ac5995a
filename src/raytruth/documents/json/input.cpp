#include "raytruth/documents/json/input.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

namespace raytruth {

namespace {

constexpr std::size_t longest_text = std::size_t{1} << 30U;

}  // namespace

std::string input_name(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string read_text(const std::string& path, std::string_view what) {
  const bool is_standard_input = path == "-";
  const auto refuse = [&](std::string_view found) {
    throw InputError(one_line(fmt::format("{}: found {}; {} is allowed", path, found, what)));
  };
  const auto unreadable = [] {
    return fmt::format("what cannot be read ({})", std::generic_category().message(errno));
  };
  std::error_code ignored;
  if (!is_standard_input && std::filesystem::is_directory(path, ignored)) refuse("a folder");
  const auto close = [](std::FILE* file) { return file == stdin ? 0 : std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(is_standard_input ? stdin : std::fopen(path.c_str(), "rb"),
                                                         close);
  if (!file) refuse(unreadable());
  std::string text;
  std::array<char, std::size_t{1} << 16U> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), file.get())) {
    text.append(part.data(), count);
    if (text.size() > longest_text) refuse("more than 1 GiB");
    if (text.size() > always_within_memory_limit && text.size() > memory_limit())
      refuse(
          fmt::format("more than {} bytes, the memory limit, which --memory-limit SIZE or RAYTRUTH_MEMORY_LIMIT sets",
                      memory_limit()));
  }
  if (std::ferror(file.get()) != 0) refuse(unreadable());
  return text;
}

}  // namespace raytruth
