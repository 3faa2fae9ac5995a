#include "experiments/output.hpp"

#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>

namespace raytruth {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::error_code& error) {
  throw OutputError(one_line(fmt::format("{}: cannot be written: {}; a place that can be written to is allowed",
                                         file.string(), error.message())));
}

std::error_code last_error() { return {errno, std::generic_category()}; }

bool write_all(std::FILE* file, std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
}

}  // namespace

void print(std::string_view text) {
  if (!write_all(stdout, text) && errno != EPIPE) refuse("standard output", last_error());
}

void say(std::string_view message) {
  const std::string line = fmt::format("raytruth: {}\n", one_line(message));
  // Nobody is left to tell if this fails.
  std::fputs(line.c_str(), stderr);
}

std::filesystem::path temporary_beside(const std::filesystem::path& file) {
  return file.parent_path() / fmt::format(".{}.{}", file.filename().string(), ::getpid());
}

void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  refuse(file, error);
}

void write_temporary(const std::filesystem::path& temporary, const std::filesystem::path& file, std::string_view text) {
  std::FILE* const stream = std::fopen(temporary.c_str(), "wb");
  if (stream == nullptr) refuse(file, last_error());
  const bool is_written = write_all(stream, text);
  const auto write_error = last_error();
  const bool is_closed = std::fclose(stream) == 0;
  if (is_written && is_closed) return;
  const auto error = is_written ? last_error() : write_error;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  refuse(file, error);
}

void write_whole(const std::filesystem::path& file, std::string_view text) {
  const auto temporary = temporary_beside(file);
  write_temporary(temporary, file, text);
  move_into_place(temporary, file);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder, error)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) refuse(folder, error);
}

}  // namespace raytruth
