#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "raytruth/volume/files/voxel_type.hpp"
#include "raytruth/volume/grid.hpp"

namespace raytruth {

enum class Encoding { raw, gzip, ascii };

[[nodiscard]] constexpr std::string_view name(Encoding encoding) {
  switch (encoding) {
    case Encoding::raw:
      return "raw";
    case Encoding::gzip:
      return "gzip";
    default:
      return "ascii";
  }
}

/// A grid and what its file says about it. A voxel's value is slope * (stored number) + intercept, in binary64 (64-bit
/// integers beyond 2^53 are rounded).
struct Volume {
  std::filesystem::path file;
  std::string_view format;  // "NRRD" or "NIfTI-1"
  VoxelType type{};
  Encoding encoding{};
  std::endian endian = std::endian::native;  // of the stored bytes; says nothing for one byte per voxel and for ASCII
  double slope = 1;
  double intercept = 0;
  /// The last stored byte of 8-bit data is 0x0A: the sign of a stream that lost its first byte and gained a newline.
  bool lost_first_byte = false;
  Grid grid;
};

/// More voxels are refused.
inline constexpr std::int64_t most_voxels = std::int64_t{1} << 33;

/// Reads a three-dimensional scalar volume: .nrrd, .nhdr (raw, gzip, ASCII; attached or detached data, in one file or
/// in several), .nii, .nii.gz, .hdr (with its .img or .img.gz); all integer and floating types in both byte orders.
/// Extra axes of size 1 are dropped. Spacing is that of the header, or the length of the space directions; 1 where an
/// NRRD does not know it. Throws InputError for everything else: one line with the file, what was found and what is
/// allowed.
[[nodiscard]] Volume read_volume(const std::filesystem::path& file);

/// Undoes the loss of the first byte: puts `first_byte` in front of the stored bytes, which moves every voxel one up in
/// x (row ends wrap), and drops the false 0x0A at the end. Throws InputError unless the voxels have 8 bits and the file
/// bears the sign.
void repair_first_byte(Volume& volume, unsigned char first_byte = 0);

}  // namespace raytruth
