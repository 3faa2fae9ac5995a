#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "raytruth/volume/files/read_volume.hpp"

namespace raytruth {

/// A file's header, understood and checked, and where its voxels lie: volume.grid.values are still to be read.
struct StoredVolume {
  /// One file with an equal share of the voxels: they begin `offset` bytes into the file, and `skip` bytes further in
  /// the (inflated) stream.
  struct Share {
    std::filesystem::path file;
    std::uint64_t offset = 0;
    std::uint64_t skip = 0;
  };

  Volume volume;
  std::vector<Share> shares;
};

/// A file format: a row of `volume_formats()`.
struct VolumeFormat {
  std::string_view extension;
  StoredVolume (*read_header)(const std::filesystem::path& file);
};

/// Every format, by its extension, in the order in which names without one are tried (read_volume.cpp names them).
[[nodiscard]] std::span<const VolumeFormat> volume_formats();

/// The header of an NRRD file, understood by Teem. Throws InputError.
[[nodiscard]] StoredVolume read_nrrd_header(const std::filesystem::path& file);

/// The header of a NIfTI-1 file. Throws InputError.
[[nodiscard]] StoredVolume read_nifti_header(const std::filesystem::path& file);

/// An axis of a stored array.
struct StoredAxis {
  std::uint64_t size = 0;
  double spacing = 1;
};

/// Refuses sizes < 1 and more than 2^33 voxels; `shape` is what the message shows.
void check_sizes(const std::filesystem::path& file, std::span<const std::uint64_t> sizes, std::string_view shape);

/// Makes the grid's size and spacing from the axes of the file (fastest first), leaving out axes of size 1 beyond the
/// third, the slowest first. Returns the kept axes' numbers. Throws InputError unless three axes are left, each with a
/// size >= 1 and a spacing > 0, of at most 2^33 voxels.
std::array<std::size_t, 3> set_axes(Volume& volume, std::span<const StoredAxis> axes);

/// The number of voxels that the header announces.
[[nodiscard]] std::uint64_t voxel_count(const Volume& volume);

/// Reads the voxels into volume.grid.values. Throws InputError for data that are shorter or longer than announced,
/// damaged, unreadable, not numbers or not finite, before memory is asked for where the file's size tells.
[[nodiscard]] Volume read_voxels(StoredVolume stored);

}  // namespace raytruth
