#include "raytruth/volume/files/byte_stream.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "raytruth/volume/files/refuse.hpp"

namespace raytruth {
namespace {

constexpr std::uint64_t deflate_most_ratio = 1032;
constexpr std::string_view readable = "a readable regular file is allowed";

std::uint64_t regular_file_size(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) refuse(file, "there is no such file", readable);
  if (error) refuse(file, error.message(), readable);
  // Pipes and devices would block or never end.
  if (!std::filesystem::is_regular_file(status)) refuse(file, "is not a regular file", readable);
  const auto size = std::filesystem::file_size(file, error);
  if (error) refuse(file, error.message(), readable);
  return size;
}

}  // namespace

/// zlib's own reader of files does not notice an end within the last eight bytes, checksum and length, where one call
/// asks for all of the data.
struct ByteStream::Inflation {
  Inflation() {
    constexpr int gzip_format = 16 + MAX_WBITS;
    if (inflateInit2(&state, gzip_format) != Z_OK) throw std::bad_alloc();
  }
  ~Inflation() { inflateEnd(&state); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  Inflation(Inflation&&) = delete;
  Inflation& operator=(Inflation&&) = delete;

  z_stream state{};
  std::vector<unsigned char> input = std::vector<unsigned char>(std::size_t{1} << 16U);
  bool is_complete = false;  // nothing was read since the end of a gzip stream, its checksum verified
};

ByteStream::ByteStream(std::filesystem::path file, std::uint64_t offset, bool gzip) : file_(std::move(file)) {
  const auto size = regular_file_size(file_);
  if (offset > size) {
    refuse(file_, fmt::format("the file ends after {} bytes", size), fmt::format("its data begin after {}", offset));
  }
  bytes_left_in_file_ = size - offset;
  stream_.open(file_, std::ios::binary);
  if (!stream_) refuse(file_, std::generic_category().message(errno), readable);
  stream_.seekg(static_cast<std::streamoff>(offset));
  if (gzip) inflation_ = std::make_unique<Inflation>();
}

ByteStream::~ByteStream() = default;

std::uint64_t ByteStream::most_bytes() const {
  if (!inflation_) return bytes_left_in_file_;
  constexpr auto largest = std::numeric_limits<std::uint64_t>::max();
  return bytes_left_in_file_ > largest / deflate_most_ratio ? largest : bytes_left_in_file_ * deflate_most_ratio;
}

std::size_t ByteStream::read_file(std::span<unsigned char> bytes) {
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (stream_.bad()) refuse(file_, "reading failed", readable);
  return static_cast<std::size_t>(stream_.gcount());
}

std::size_t ByteStream::read(std::span<unsigned char> bytes) {
  if (!inflation_) return read_file(bytes);
  constexpr std::string_view allowed = "whole gzip streams are allowed";
  auto& state = inflation_->state;
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (state.avail_in == 0) {
      state.next_in = inflation_->input.data();
      state.avail_in = static_cast<unsigned>(read_file(inflation_->input));
      if (state.avail_in == 0) {
        if (inflation_->is_complete) break;
        refuse(file_, "the gzip data end early", allowed);
      }
    }
    if (std::exchange(inflation_->is_complete, false)) inflateReset(&state);
    constexpr std::size_t most_per_call = std::size_t{1} << 30U;
    const auto part = bytes.subspan(done, std::min(bytes.size() - done, most_per_call));
    state.next_out = part.data();
    state.avail_out = static_cast<unsigned>(part.size());
    const int result = inflate(&state, Z_NO_FLUSH);
    if (result != Z_OK && result != Z_STREAM_END) {
      refuse(file_, fmt::format("the gzip data are damaged: {}", state.msg != nullptr ? state.msg : zError(result)),
             allowed);
    }
    inflation_->is_complete = result == Z_STREAM_END;
    done += part.size() - state.avail_out;
  }
  return done;
}

void ByteStream::skip(std::uint64_t count) {
  std::array<unsigned char, 1U << 16U> passed_over{};
  while (count > 0) {
    const auto wanted = std::min<std::uint64_t>(count, passed_over.size());
    const auto got = read(std::span(passed_over).first(wanted));
    if (got == 0) return;
    count -= got;
  }
}

}  // namespace raytruth
