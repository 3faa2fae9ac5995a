#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

namespace raytruth {

std::span<const VolumeFormat> volume_formats() {
  static constexpr std::array formats{
      VolumeFormat{".nrrd", read_nrrd_header}, VolumeFormat{".nhdr", read_nrrd_header},
      VolumeFormat{".nii", read_nifti_header}, VolumeFormat{".nii.gz", read_nifti_header},
      VolumeFormat{".hdr", read_nifti_header},
  };
  return formats;
}

Volume read_volume(const std::filesystem::path& file) {
  const auto file_name = file.filename().string();
  std::vector<std::string_view> known;
  for (const VolumeFormat& format : volume_formats()) {
    if (file_name.ends_with(format.extension)) return read_voxels(format.read_header(file));
    known.push_back(format.extension);
  }
  const std::string_view last = known.back();
  known.pop_back();
  refuse(file, "the name does not tell the format", fmt::format("{} and {} are allowed", fmt::join(known, ", "), last));
}

void repair_first_byte(Volume& volume, unsigned char first_byte) {
  if (facts(volume.type).bytes != 1) {
    refuse(volume.file, fmt::format("the voxels have the type {}", facts(volume.type).name),
           "\"repair\": \"first_byte\" is allowed for 8-bit voxels");
  }
  if (!volume.lost_first_byte) {
    refuse(volume.file, "the last stored byte is not 0x0A",
           "\"repair\": \"first_byte\" is allowed for a file that bears this sign");
  }
  auto& values = volume.grid.values;
  std::move_backward(values.begin(), values.end() - 1, values.end());
  const int stored = volume.type == VoxelType::int8 ? static_cast<std::int8_t>(first_byte) : first_byte;
  values.front() = volume.slope * stored + volume.intercept;
  volume.lost_first_byte = false;
}

}  // namespace raytruth
