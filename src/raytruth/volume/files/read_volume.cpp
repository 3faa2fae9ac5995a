#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

namespace raytruth {

Volume read_volume(const std::filesystem::path& file) {
  const auto file_name = file.filename().string();
  if (file_name.ends_with(".nrrd") || file_name.ends_with(".nhdr")) return read_voxels(read_nrrd_header(file));
  if (file_name.ends_with(".nii") || file_name.ends_with(".nii.gz") || file_name.ends_with(".hdr")) {
    return read_voxels(read_nifti_header(file));
  }
  refuse(file, "the name does not tell the format", ".nrrd, .nhdr, .nii, .nii.gz and .hdr are allowed");
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
