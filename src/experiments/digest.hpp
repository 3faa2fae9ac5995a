#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace raytruth {

/// The SHA-256 of a text (FIPS 180-4) as 64 hexadecimal digits. It tells damage and mix-ups: who changes the text can
/// change its digest too.
std::string sha256(std::string_view text);

/// The SHA-256 of a file, which is read piece by piece. Throws InputError where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace raytruth
