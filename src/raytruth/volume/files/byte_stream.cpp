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
constexpr std::array<unsigned char, 2> gzip_magic{0x1F, 0x8B};
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
  bool is_complete = false;  // a gzip stream ended, its checksum verified, and no other has begun
};

ByteStream::ByteStream(std::filesystem::path file, std::uint64_t offset, bool gzip) : file_(std::move(file)) {
  const auto size = regular_file_size(file_);
  if (offset > size) {
    refuse(file_, fmt::format("the file ends after {} bytes", size), fmt::format("its data begin after {}", offset));
  }
  bytes_in_file_ = size - offset;
  stream_.open(file_, std::ios::binary);
  if (!stream_) refuse(file_, std::generic_category().message(errno), readable);
  stream_.seekg(static_cast<std::streamoff>(offset));
  if (!gzip) return;
  std::array<unsigned char, gzip_magic.size()> first{};
  read_file(first);
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  bytes_read_ = 0;
  if (first == gzip_magic) inflation_ = std::make_unique<Inflation>();
}

ByteStream::~ByteStream() = default;

std::uint64_t ByteStream::most_bytes() const {
  if (!inflation_) return bytes_in_file_;
  constexpr auto largest = std::numeric_limits<std::uint64_t>::max();
  return bytes_in_file_ > largest / deflate_most_ratio ? largest : bytes_in_file_ * deflate_most_ratio;
}

std::size_t ByteStream::read_file(std::span<unsigned char> bytes) {
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (stream_.bad()) refuse(file_, "reading failed", readable);
  const auto count = static_cast<std::size_t>(stream_.gcount());
  bytes_read_ += count;
  return count;
}

/// Makes at least so many bytes of the file wait to be inflated; false where it has fewer left.
bool ByteStream::fill_input(std::size_t least) {
  auto& state = inflation_->state;
  auto& input = inflation_->input;
  while (state.avail_in < least) {
    std::copy_n(state.next_in, state.avail_in, input.data());
    state.next_in = input.data();
    const auto more = read_file(std::span(input).subspan(state.avail_in));
    if (more == 0) return false;
    state.avail_in += static_cast<unsigned>(more);
  }
  return true;
}

/// Behind a gzip stream: passes over padding, and tells whether another stream follows. What else does is ignored.
bool ByteStream::begins_next_gzip() {
  auto& state = inflation_->state;
  while (fill_input(1) && *state.next_in == 0) {
    ++state.next_in;
    --state.avail_in;
  }
  if (fill_input(gzip_magic.size()) && std::equal(gzip_magic.begin(), gzip_magic.end(), state.next_in)) return true;
  ignored_bytes_ = state.avail_in + bytes_in_file_ - bytes_read_;
  return false;
}

std::size_t ByteStream::read(std::span<unsigned char> bytes) {
  if (!inflation_) return read_file(bytes);
  constexpr std::string_view allowed = "whole gzip streams are allowed";
  auto& state = inflation_->state;
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (inflation_->is_complete) {
      if (!begins_next_gzip()) break;
      inflation_->is_complete = false;
      inflateReset(&state);
    }
    if (!fill_input(1)) refuse(file_, "the gzip data end early", allowed);
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

std::uint64_t ByteStream::count_rest() {
  std::vector<unsigned char> passed_over(std::size_t{1} << 16U);
  std::uint64_t count = 0;
  while (const auto got = read(passed_over)) count += got;
  return count;
}

bool is_gzip_file(const std::filesystem::path& file) { return ByteStream(file, 0, true).is_gzip(); }

}  // namespace raytruth
