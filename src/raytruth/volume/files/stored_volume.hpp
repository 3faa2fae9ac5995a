#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
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

  /// The file has `count` volumes, and the one with the number `step` is read. As many neighbouring numbers as
  /// `together` belong to the same volume: 1 where time is the fastest axis, a whole volume's where it is the slowest.
  struct Series {
    std::uint64_t together = 1;
    std::uint64_t count = 1;
    std::uint64_t step = 0;
  };

  Volume volume;
  std::vector<Share> shares;
  Series series;
  bool is_z_fastest = false;  ///< the numbers lie in Fortran's order of (z, y, x)
};

/// A file format: a row of `volume_formats()`.
struct VolumeFormat {
  std::string_view extension;
  StoredVolume (*read_header)(const std::filesystem::path& file, const VolumeChoices& choices);
};

/// Every format, by its extension, in the order in which names without one are tried (read_volume.cpp names them).
[[nodiscard]] std::span<const VolumeFormat> volume_formats();

/// The format that the file's extension names, in whatever case; null: none.
[[nodiscard]] const VolumeFormat* format_of_name(std::string_view file_name);

/// The header of a volume's file, by its extension or else its first bytes. Throws InputError.
[[nodiscard]] StoredVolume read_volume_header(const std::filesystem::path& file, const VolumeChoices& choices);

/// The header of an NRRD file, understood by Teem. Throws InputError.
[[nodiscard]] StoredVolume read_nrrd_header(const std::filesystem::path& file, const VolumeChoices& choices);

/// The header of a NIfTI file. Throws InputError.
[[nodiscard]] StoredVolume read_nifti_header(const std::filesystem::path& file, const VolumeChoices& choices);

/// The header of a NumPy file. Throws InputError.
[[nodiscard]] StoredVolume read_npy_header(const std::filesystem::path& file, const VolumeChoices& choices);

/// An axis of a stored array.
struct StoredAxis {
  enum class Kind { space, time, other };

  std::uint64_t size = 0;
  double spacing = 1;
  Kind kind = Kind::space;
  std::string what = {};  ///< what it is if not of space: "axis 4 is time, 2 steps 2.5 s apart"
};

/// Refuses sizes < 1 and more than 2^33 voxels; `shape` is what the message shows.
void check_sizes(const std::filesystem::path& file, std::span<const std::uint64_t> sizes, std::string_view shape);

/// Makes the grid's size and spacing, and the series, from the axes of the file (fastest first), leaving out axes of
/// size 1 beyond the third: first those that are not of space, then the slowest. A spacing < 0 is taken without its
/// sign, with a warning. Throws InputError unless three axes are left, each of space or of size 1, with a size >= 1 and
/// a spacing that is not 0, of at most 2^33 voxels; and for a series without a choice.
void set_axes(StoredVolume& stored, std::span<const StoredAxis> axes, const VolumeChoices& choices);

/// The warning that directions of axes, which `what` names, are not perpendicular, as a grid's are: at angles of more
/// than 0.06 degrees. Nothing where they are.
[[nodiscard]] std::optional<std::string> shear_warning(const std::vector<std::vector<double>>& directions,
                                                       std::string_view what);

/// What a refusal says of volumes that cannot be read as they are.
inline constexpr std::string_view npy_is_the_way_in = "what NumPy saves as .npy, with the shape (z, y, x), always is";

/// The number of voxels of the volume that is read.
[[nodiscard]] std::uint64_t voxel_count(const Volume& volume);

/// The number of voxels that the header announces, of all volumes of a series.
[[nodiscard]] std::uint64_t stored_count(const StoredVolume& stored);

/// Reads the voxels into volume.grid.values. Throws InputError for data that are shorter than announced, damaged,
/// unreadable, not numbers or not finite, and for voxels that need more memory than the limit, before memory is asked
/// for.
[[nodiscard]] Volume read_voxels(StoredVolume stored, const VolumeChoices& choices, std::uint64_t memory_limit);

}  // namespace raytruth
