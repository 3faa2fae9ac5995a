#include "volume/byte_stream.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "volume/refuse.hpp"

namespace raytruth {
namespace {

constexpr std::uint64_t deflate_most_ratio = 1032;
constexpr std::string_view readable = "a readable regular file is allowed";

std::string system_message(int error) { return std::generic_category().message(error); }

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

void ByteStream::Close::operator()(gzFile_s* opened) const { gzclose_r(opened); }

ByteStream::ByteStream(std::filesystem::path file, std::uint64_t offset, bool gzip) : file_(std::move(file)) {
  const auto size = regular_file_size(file_);
  if (offset > size) {
    refuse(file_, fmt::format("the file ends after {} bytes", size), fmt::format("its data begin after {}", offset));
  }
  bytes_left_in_file_ = size - offset;
  if (gzip) {
    const int descriptor = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) refuse(file_, system_message(errno), readable);
    const bool at_data = ::lseek(descriptor, static_cast<off_t>(offset), SEEK_SET) >= 0;
    inflated_.reset(at_data ? gzdopen(descriptor, "rb") : nullptr);
    if (!inflated_) {
      ::close(descriptor);
      refuse(file_, "cannot be read", readable);
    }
    gzbuffer(inflated_.get(), 1U << 17U);
    // zlib would hand out data without the gzip signature as they are.
    if (gzdirect(inflated_.get()) != 0)
      refuse(file_, "the data are not in gzip format", "gzip as announced is allowed");
  } else {
    raw_.open(file_, std::ios::binary);
    if (!raw_) refuse(file_, system_message(errno), readable);
    raw_.seekg(static_cast<std::streamoff>(offset));
  }
}

std::uint64_t ByteStream::most_bytes() const {
  if (!inflated_) return bytes_left_in_file_;
  constexpr auto largest = std::numeric_limits<std::uint64_t>::max();
  return bytes_left_in_file_ > largest / deflate_most_ratio ? largest : bytes_left_in_file_ * deflate_most_ratio;
}

std::size_t ByteStream::read(std::span<unsigned char> bytes) {
  if (!inflated_) {
    raw_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (raw_.bad()) refuse(file_, "reading failed", readable);
    return static_cast<std::size_t>(raw_.gcount());
  }
  std::size_t done = 0;
  while (done < bytes.size()) {
    constexpr std::size_t most_per_call = std::size_t{1} << 30U;
    const auto part = bytes.subspan(done, std::min(bytes.size() - done, most_per_call));
    const int got = gzread(inflated_.get(), part.data(), static_cast<unsigned>(part.size()));
    int error = Z_OK;
    const std::string_view message = gzerror(inflated_.get(), &error);  // "<fd:3>: what is wrong"
    if (got < 0 || error != Z_OK) {
      refuse(file_,
             fmt::format("the gzip data are damaged{}", message.substr(std::min(message.find(": "), message.size()))),
             "a whole gzip stream is allowed");
    }
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
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
