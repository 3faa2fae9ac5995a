#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// What whoever asks for a volume decides where its file leaves a choice.
struct VolumeChoices {
  std::optional<double> nan = {};              ///< what voxels become that are NaN; without it they are refused
  std::optional<std::int64_t> time_step = {};  ///< which volume of a series, from 0; without it series are refused
  std::optional<std::array<double, 3>> spacing = {};  ///< x, y, z, instead of what the file says
};

/// A grid and what its file says about it. A voxel's value is slope * (stored number) + intercept, in binary64 (64-bit
/// integers beyond 2^53 are rounded, which makes a warning).
struct Volume {
  std::filesystem::path file;
  std::string_view format;  // "NRRD", "NIfTI-1", "NIfTI-2" or "NPY"
  VoxelType type{};
  Encoding encoding{};
  std::endian endian = std::endian::native;  // of the stored bytes; says nothing for one byte per voxel and for ASCII
  double slope = 1;
  double intercept = 0;
  /// The last stored byte of 8-bit data is 0x0A: the sign of a stream that lost its first byte and gained a newline.
  bool lost_first_byte = false;
  bool has_spacing = true;  // the file states it, or VolumeChoices do; otherwise it is 1
  /// What was mended, chosen, rounded or left unread, a phrase each, without the file's name.
  std::vector<std::string> warnings;
  Grid grid;
};

/// More voxels are refused.
inline constexpr std::int64_t most_voxels = std::int64_t{1} << 33;

/// The memory of this machine, in bytes.
[[nodiscard]] std::uint64_t memory_of_machine();

/// Reads a three-dimensional scalar volume: .nrrd, .nhdr (raw, gzip, ASCII; attached or detached data, in one file or
/// in several), .nii, .nii.gz, .hdr (NIfTI-1 and 2; with its .img or .img.gz), .npy (shape (z, y, x), in C or Fortran
/// order); all integer types and binary32 and 64 in both byte orders. The case of extensions does not matter; a file
/// without one of them is known by its first bytes.
///
/// Extra axes of size 1 are dropped. An axis of time, or a list, makes a series of volumes, of which `choices` name
/// one. What no axis of space is otherwise, such as the channels of a colour, is refused. Spacing is that of the
/// header, the length of the space directions, or what the ends of the axes give; 1 where the file does not know it.
///
/// Files are read as the programs that write them do: an extent that runs backwards, bytes behind the data or a scaling
/// that is no number make a warning. Throws InputError for everything else, one line with the file, what was found and
/// what is allowed; so for voxels that need more bytes than `memory_limit` (8 each), before any is asked for.
[[nodiscard]] Volume read_volume(const std::filesystem::path& file, const VolumeChoices& choices = {},
                                 std::uint64_t memory_limit = memory_of_machine());

/// Undoes the loss of the first byte: puts `first_byte` in front of the stored bytes, which moves every voxel one up in
/// x (row ends wrap), and drops the false 0x0A at the end. Throws InputError unless the voxels have 8 bits and the file
/// bears the sign.
void repair_first_byte(Volume& volume, unsigned char first_byte = 0);

}  // namespace raytruth
