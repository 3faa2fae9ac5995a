#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>

namespace raytruth {

/// The bytes of a regular file from `offset` on, inflated if `gzip` (several gzip streams in a row are one).
/// Every member throws InputError: for what cannot be opened or read, and for gzip data that are none, that end early,
/// whose checksum does not fit or that something else follows.
class ByteStream {
 public:
  explicit ByteStream(std::filesystem::path file, std::uint64_t offset = 0, bool gzip = false);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  ByteStream(ByteStream&&) = delete;
  ByteStream& operator=(ByteStream&&) = delete;

  /// No more bytes than this can come: those left in the file, and 1032 times as many where deflate packed them
  /// (258 bytes per 2 bits; zlib.net/zlib_tech.html).
  [[nodiscard]] std::uint64_t most_bytes() const;

  /// Fills `bytes` from the stream and returns how many there were: fewer than asked for only at the end. The checks of
  /// gzip happen where the end is met: ask for one byte more than expected.
  std::size_t read(std::span<unsigned char> bytes);

  /// Passes over `count` bytes, or those left.
  void skip(std::uint64_t count);

 private:
  struct Inflation;

  std::size_t read_file(std::span<unsigned char> bytes);

  std::filesystem::path file_;
  std::uint64_t bytes_left_in_file_ = 0;
  std::ifstream stream_;
  std::unique_ptr<Inflation> inflation_;  // if gzip
};

}  // namespace raytruth
