#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace raytruth {

/// What was asked for is there, and cannot be written: a full disk, no permission. The message is one line with the
/// name of the file. The program exits with 4.
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writes to standard output. A reader that stops early, as `head` does, is no error.
/// Throws OutputError for everything else, as a full disk.
void print(std::string_view text);

/// Writes "raytruth: MESSAGE" to standard error as one line.
void say(std::string_view message);

/// A name beside `file` for what is to become it.
std::filesystem::path temporary_beside(const std::filesystem::path& file);

/// Gives `temporary` its final name. Throws OutputError, and then removes it.
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& file);

/// The file appears whole or not at all: written beside it, then renamed. Throws OutputError.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// Writes `text` to `temporary`, which is to become `file`; OutputError names the latter, and then removes the former.
void write_temporary(const std::filesystem::path& temporary, const std::filesystem::path& file, std::string_view text);

/// Makes the folder unless it exists. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace raytruth
