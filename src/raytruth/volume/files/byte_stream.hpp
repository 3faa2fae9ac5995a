#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>

namespace raytruth {

/// The bytes of a regular file from `offset` on. If `gzip` they are inflated, unless they do not begin as gzip data do:
/// then they are what they are, as zlib has it. Several gzip streams in a row are one, and zeros between and after them
/// are padding, as gzip has it; what else follows them is left alone (`ignored_bytes`).
/// Every member throws InputError: for what cannot be opened or read, and for gzip data that are damaged, that end
/// early or whose checksum does not fit.
class ByteStream {
 public:
  explicit ByteStream(std::filesystem::path file, std::uint64_t offset = 0, bool gzip = false);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  ByteStream(ByteStream&&) = delete;
  ByteStream& operator=(ByteStream&&) = delete;

  /// Whether the bytes are inflated.
  [[nodiscard]] bool is_gzip() const { return inflation_ != nullptr; }

  /// No more bytes than this can come: those left in the file, and 1032 times as many where deflate packed them
  /// (258 bytes per 2 bits; zlib.net/zlib_tech.html).
  [[nodiscard]] std::uint64_t most_bytes() const;

  /// Fills `bytes` from the stream and returns how many there were: fewer than asked for only at the end. The checks of
  /// gzip happen where the end is met: ask for one byte more than expected.
  std::size_t read(std::span<unsigned char> bytes);

  /// Passes over `count` bytes, or those left.
  void skip(std::uint64_t count);

  /// Reads to the end, and returns how many bytes there were.
  std::uint64_t count_rest();

  /// How many bytes of the file stand behind its gzip data and are neither such data nor padding; known at the end.
  [[nodiscard]] std::uint64_t ignored_bytes() const { return ignored_bytes_; }

 private:
  struct Inflation;

  std::size_t read_file(std::span<unsigned char> bytes);
  bool fill_input(std::size_t least);
  bool begins_next_gzip();

  std::filesystem::path file_;
  std::uint64_t bytes_in_file_ = 0;  // from `offset` on
  std::uint64_t bytes_read_ = 0;     // of these
  std::uint64_t ignored_bytes_ = 0;
  std::ifstream stream_;
  std::unique_ptr<Inflation> inflation_;  // if gzip
};

/// Whether the file's first bytes are those of gzip data. Throws InputError for what cannot be opened or read.
[[nodiscard]] bool is_gzip_file(const std::filesystem::path& file);

}  // namespace raytruth
