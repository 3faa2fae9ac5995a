#pragma once

#include <filesystem>
#include <string_view>

namespace raytruth {

/// Writes to standard output. A reader that stops early, as `head` does, is no error.
/// Throws InputError for everything else, as a full disk.
void print(std::string_view text);

/// Writes "raytruth: MESSAGE" to standard error as one line.
void say(std::string_view message);

/// A name beside `file` for what is to become it.
std::filesystem::path temporary_beside(const std::filesystem::path& file);

/// Gives `temporary` its final name. Throws InputError, and then removes it.
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& file);

/// The file appears whole or not at all: written beside it, then renamed. Throws InputError.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// Makes the folder unless it exists. Throws InputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace raytruth
