#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <new>
#include <numeric>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

// Teem and libnifti read the headers; the voxels are read here, for both alike. Teem 1.12 does not look at the checksum
// of gzip data, lets ASCII numbers overflow its buffer and their type, and loses memory when data end early; libnifti
// asks for the announced memory before it looks at the file and fills what is missing with zeros.

namespace raytruth {
namespace {

constexpr std::size_t chunk_voxels = std::size_t{1} << 16U;

/// Takes the voxels one by one, in the file's order.
class Values {
 public:
  explicit Values(Volume& volume) : volume_(volume) {}

  void add(double stored) {
    const double value = volume_.slope * stored + volume_.intercept;
    if (!std::isfinite(value)) refuse_voxel(value);
    volume_.grid.values.push_back(value);
  }

  /// "voxel (i, j, k)", the next one.
  [[nodiscard]] std::string place() const {
    const auto [nx, ny, nz] = volume_.grid.size;
    const auto index = static_cast<std::int64_t>(volume_.grid.values.size());
    return fmt::format("voxel ({}, {}, {})", index % nx, index / nx % ny, index / nx / ny);
  }

 private:
  [[noreturn]] void refuse_voxel(double value) const {
    refuse(volume_.file, fmt::format("{} is {}", place(), value), "only finite values are allowed");
  }

  Volume& volume_;
};

template <class T>
T from_bytes(const unsigned char* bytes, std::endian endian) {
  std::array<unsigned char, sizeof(T)> ordered{};
  std::memcpy(ordered.data(), bytes, sizeof(T));
  if (endian != std::endian::native) std::reverse(ordered.begin(), ordered.end());
  return std::bit_cast<T>(ordered);
}

template <class T>
void add_binary(ByteStream& stream, std::uint64_t count, const StoredVolume::Share& share, Volume& volume) {
  Values values(volume);
  std::vector<unsigned char> chunk(chunk_voxels * sizeof(T));
  for (std::uint64_t done = 0; done < count;) {
    const auto wanted = std::min<std::uint64_t>(count - done, chunk_voxels);
    const auto got = stream.read(std::span(chunk).first(wanted * sizeof(T)));
    if (got < wanted * sizeof(T)) {
      refuse(share.file, fmt::format("the data end after {} bytes", done * sizeof(T) + got),
             fmt::format("the header announces {}", count * sizeof(T)));
    }
    for (std::size_t voxel = 0; voxel < wanted; ++voxel) {
      values.add(static_cast<double>(from_bytes<T>(&chunk[voxel * sizeof(T)], volume.endian)));
    }
    volume.lost_first_byte = sizeof(T) == 1 && chunk[wanted - 1] == '\n';
    done += wanted;
  }
  if (stream.read(std::span(chunk).first(1)) != 0) {
    refuse(share.file, fmt::format("the data go on after {} bytes", count * sizeof(T)),
           "as many bytes as the header announces are allowed");
  }
}

/// Numbers that white space or commas separate.
class Words {
 public:
  explicit Words(ByteStream& stream) : stream_(stream), buffer_(std::size_t{1} << 16U) {}

  /// More characters of a word are not kept: no number needs them.
  static constexpr std::size_t longest = 1000;

  /// The next word; empty at the end.
  std::string_view next() {
    word_.clear();
    for (;;) {
      if (position_ == filled_) {
        filled_ = stream_.read(buffer_);
        position_ = 0;
        if (filled_ == 0) return word_;
      }
      const char character = static_cast<char>(buffer_[position_++]);
      if (std::string_view(" \t\r\n\f\v,").find(character) != std::string_view::npos) {
        if (!word_.empty()) return word_;
      } else if (word_.size() < longest) {
        word_.push_back(character);
      }
    }
  }

 private:
  ByteStream& stream_;
  std::vector<unsigned char> buffer_;
  std::size_t position_ = 0;
  std::size_t filled_ = 0;
  std::string word_;
};

template <class T>
void add_ascii(ByteStream& stream, std::uint64_t count, const StoredVolume::Share& share, Volume& volume) {
  Values values(volume);
  Words words(stream);
  for (std::uint64_t done = 0; done < count; ++done) {
    const auto word = words.next();
    if (word.empty()) {
      refuse(share.file, fmt::format("the data end after {} numbers", done),
             fmt::format("the header announces {}", count));
    }
    const auto digits = word.front() == '+' ? word.substr(1) : word;
    T number{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size() || word.size() == Words::longest) {
      refuse(share.file, fmt::format("{} is \"{}\"", values.place(), printable(word)),
             fmt::format("a number of type {} is allowed", facts(volume.type).name));
    }
    values.add(static_cast<double>(number));
  }
  if (!words.next().empty()) {
    refuse(share.file, fmt::format("the data go on after {} numbers", count),
           "as many numbers as the header announces are allowed");
  }
}

template <class T>
void add_share(const StoredVolume::Share& share, std::uint64_t count, Volume& volume) {
  ByteStream stream(share.file, share.offset, volume.encoding == Encoding::gzip);
  stream.skip(share.skip);
  if (volume.encoding == Encoding::ascii) {
    add_ascii<T>(stream, count, share, volume);
  } else {
    add_binary<T>(stream, count, share, volume);
  }
}

auto adder(VoxelType type) {
  switch (type) {
    case VoxelType::int8:
      return add_share<std::int8_t>;
    case VoxelType::uint8:
      return add_share<std::uint8_t>;
    case VoxelType::int16:
      return add_share<std::int16_t>;
    case VoxelType::uint16:
      return add_share<std::uint16_t>;
    case VoxelType::int32:
      return add_share<std::int32_t>;
    case VoxelType::uint32:
      return add_share<std::uint32_t>;
    case VoxelType::int64:
      return add_share<std::int64_t>;
    case VoxelType::uint64:
      return add_share<std::uint64_t>;
    case VoxelType::float32:
      return add_share<float>;
    default:
      return add_share<double>;
  }
}

/// Refuses a file that is too small for its share of the voxels, whatever it holds.
void check_capacity(const StoredVolume::Share& share, std::uint64_t count, const Volume& volume) {
  const bool ascii = volume.encoding == Encoding::ascii;
  const auto most = ByteStream(share.file, share.offset, volume.encoding == Encoding::gzip).most_bytes();
  // In ASCII every voxel takes a digit, and something stands between two of them.
  const auto least = ascii ? 2 * count - 1 : count * static_cast<std::uint64_t>(facts(volume.type).bytes);
  if (share.skip > most || least > most - share.skip) {
    refuse(share.file,
           fmt::format("the file can hold no more than {} bytes of data", most - std::min(most, share.skip)),
           fmt::format("the header announces {} voxels, {} bytes", count, least));
  }
}

}  // namespace

void check_sizes(const std::filesystem::path& file, std::span<const std::uint64_t> sizes, std::string_view shape) {
  auto most = static_cast<std::uint64_t>(most_voxels);
  for (const auto size : sizes) {
    if (size < 1 || size > most) {
      refuse(file, fmt::format("the sizes are {}", shape), "sizes >= 1 and at most 2^33 voxels are allowed");
    }
    most /= size;
  }
}

std::array<std::size_t, 3> set_axes(Volume& volume, std::span<const StoredAxis> axes) {
  std::vector<std::uint64_t> sizes;
  for (const auto& axis : axes) sizes.push_back(axis.size);
  const auto shape = fmt::format("{}", fmt::join(sizes, " x "));
  check_sizes(volume.file, sizes, shape);

  std::vector<std::size_t> kept(axes.size());
  std::iota(kept.begin(), kept.end(), 0);
  for (std::size_t axis = axes.size(); axis-- > 0 && kept.size() > 3;) {
    if (sizes[axis] == 1) kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(axis));
  }
  if (kept.size() != 3) {
    refuse(volume.file, "the sizes are " + shape, "three axes are allowed, and further ones of size 1");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [size, spacing] = axes[kept[axis]];
    if (!(spacing > 0 && std::isfinite(spacing))) {
      refuse(volume.file, fmt::format("the spacing of axis {} is {}", kept[axis], spacing),
             "a finite number > 0 is allowed");
    }
    volume.grid.size[axis] = static_cast<std::int64_t>(size);
    volume.grid.spacing[axis] = spacing;
  }
  return {kept[0], kept[1], kept[2]};
}

std::uint64_t voxel_count(const Volume& volume) {
  const auto& size = volume.grid.size;
  return static_cast<std::uint64_t>(size[0] * size[1] * size[2]);
}

Volume read_voxels(StoredVolume stored) {
  auto& volume = stored.volume;
  const auto count = voxel_count(volume) / stored.shares.size();
  for (const auto& share : stored.shares) check_capacity(share, count, volume);
  try {
    volume.grid.values.reserve(voxel_count(volume));
  } catch (const std::bad_alloc&) {
    refuse(volume.file,
           fmt::format("its {} voxels need {} MiB of memory", voxel_count(volume), voxel_count(volume) >> 17U),
           "what this machine has is allowed");
  }
  for (const auto& share : stored.shares) adder(volume.type)(share, count, volume);
  return std::move(volume);
}

}  // namespace raytruth
