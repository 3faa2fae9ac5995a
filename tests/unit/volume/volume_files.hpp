#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "raytruth/core/error.hpp"
#include "raytruth/volume/files/read_volume.hpp"

// Volume files, written byte by byte, and what tests ask of them.

namespace raytruth::test {

/// A folder of its own for each test, gone afterwards.
class VolumeFiles : public testing::Test {
 public:
  VolumeFiles() {
    auto pattern = (std::filesystem::temp_directory_path() / "raytruth_volume_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~VolumeFiles() override {
    std::error_code none;
    std::filesystem::remove_all(folder_, none);
  }

 protected:
  [[nodiscard]] std::filesystem::path folder() const { return folder_; }

  [[nodiscard]] std::filesystem::path write(const std::string& name, std::string_view content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

 private:
  std::filesystem::path folder_;
};

inline std::string gzip(std::string_view plain) {
  z_stream stream{};
  constexpr int gzip_format = 15 + 16;
  EXPECT_EQ(deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, gzip_format, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, plain.size()), '\0');
  std::vector<unsigned char> bytes(plain.begin(), plain.end());
  stream.next_in = bytes.data();
  stream.avail_in = static_cast<unsigned>(bytes.size());
  stream.next_out = reinterpret_cast<unsigned char*>(packed.data());
  stream.avail_out = static_cast<unsigned>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

template <class T>
std::string stored(std::span<const T> values, std::endian endian) {
  std::string bytes;
  for (const T value : values) {
    auto number = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (endian != std::endian::native) std::reverse(number.begin(), number.end());
    bytes.append(number.data(), number.size());
  }
  return bytes;
}

/// Twelve values of the type, its limits among them: a volume of 3 x 2 x 2.
template <class T>
std::vector<T> twelve_values() {
  using Limits = std::numeric_limits<T>;
  return {Limits::lowest(), Limits::max(), T(0), T(1), T(2), T(3), T(5), T(10), T(17), T(42), T(99), T(100)};
}

template <class T>
std::vector<double> as_double(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

/// Reading `file` throws InputError with one line that names the file (or `named`) and contains `phrase`; nothing is
/// printed.
inline void expect_refused(const std::filesystem::path& file, std::string_view phrase, std::string_view named = {},
                           const VolumeChoices& choices = {}) {
  std::string message;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    (void)read_volume(file, choices);
    message = "nothing: the volume was read";
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const auto name = named.empty() ? file.filename().string() : std::string(named);
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_NE(message.find(name + ": "), std::string::npos) << message << "\nshould name " << name;
  EXPECT_NE(message.find("; "), std::string::npos) << message << "\nshould say what is allowed";
  EXPECT_NE(message.find(phrase), std::string::npos) << message << "\nshould contain: " << phrase;
}

}  // namespace raytruth::test
