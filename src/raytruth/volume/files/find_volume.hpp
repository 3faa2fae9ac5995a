#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "raytruth/core/error.hpp"

namespace raytruth {

/// A named volume is in none of the folders. An experiment turns this into a refused row, which says `why`: that names
/// no folder, nor anything else that differs between machines.
struct VolumeAbsent : InputError {
  /// `hint` is what to try instead on this machine; empty: nothing.
  explicit VolumeAbsent(const std::string& why_absent, const std::string& hint = {})
      : InputError(why_absent + (hint.empty() ? "" : " (" + hint + ")")), why(why_absent) {}

  std::string why;
};

/// The folders that a text names, separated by ':'.
[[nodiscard]] std::vector<std::filesystem::path> folders_in(std::string_view separated);

/// Those of the environment variable RAYTRUTH_DATA.
[[nodiscard]] std::vector<std::filesystem::path> folders_of_environment();

/// Where volumes are looked for: the folders of the option --data, those of the environment variable RAYTRUTH_DATA
/// (both separated by ':'), and the templates of Debian's package mricron-data, in this order.
[[nodiscard]] std::vector<std::filesystem::path> volume_folders(std::string_view data_option = {});

/// The file of a volume: `name` itself where that is a path (it has a '/' or the extension of a volume) and exists;
/// otherwise the first folder's file `name`, if it has an extension, or name.nrrd, .nhdr, .nii, .nii.gz, .hdr, .npy;
/// otherwise the file `name` here, whatever its extension. Throws VolumeAbsent.
[[nodiscard]] std::filesystem::path find_volume(const std::string& name,
                                                const std::vector<std::filesystem::path>& folders);

/// A volume that `find_volume` would find by its name.
struct NamedVolume {
  std::string name;  ///< of the file, without its extension
  std::filesystem::path file;
};

/// The volumes of the folders, by name; of several with one name that which is found. Data of headers (.img) are none.
[[nodiscard]] std::vector<NamedVolume> volumes_in(const std::vector<std::filesystem::path>& folders);

/// Those of the folders that are not there, or are no folders.
[[nodiscard]] std::vector<std::filesystem::path> absent_folders(const std::vector<std::filesystem::path>& folders);

}  // namespace raytruth
