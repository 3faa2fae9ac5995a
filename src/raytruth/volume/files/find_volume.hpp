#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "raytruth/core/error.hpp"

namespace raytruth {

/// A named volume is in none of the folders. An experiment turns this into a refused row; the message names no folder.
struct VolumeAbsent : InputError {
  using InputError::InputError;
};

/// Where volumes are looked for: the folders of the option --data, those of the environment variable RAYTRUTH_DATA
/// (both separated by ':'), and the templates of Debian's package mricron-data, in this order.
[[nodiscard]] std::vector<std::filesystem::path> volume_folders(std::string_view data_option = {});

/// The file of a volume: `name` itself where that is a path (it has a '/' or the extension of a volume) and exists;
/// otherwise the first folder's file `name`, if it has an extension, or name.nrrd, .nhdr, .nii, .nii.gz, .hdr.
/// Throws VolumeAbsent.
[[nodiscard]] std::filesystem::path find_volume(const std::string& name,
                                                const std::vector<std::filesystem::path>& folders);

}  // namespace raytruth
