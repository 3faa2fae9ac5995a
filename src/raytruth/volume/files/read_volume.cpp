#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

namespace raytruth {

namespace {

/// The format whose files begin as this one does, gzip data inflated; null: none.
const VolumeFormat* format_of_content(const std::filesystem::path& file) {
  constexpr std::string_view nrrd = "NRRD0";
  constexpr std::string_view npy = "\x93NUMPY";
  constexpr std::array<std::string_view, 4> nifti{
      std::string_view("\x5C\x01\0\0", 4), std::string_view("\0\0\x01\x5C", 4), std::string_view("\x1C\x02\0\0", 4),
      std::string_view("\0\0\x02\x1C", 4)};
  std::array<unsigned char, 8> bytes{};
  const auto length = ByteStream(file, 0, true).read(bytes);
  const std::string_view first(reinterpret_cast<const char*>(bytes.data()), length);
  if (first.starts_with(nrrd)) return format_of_name(".nrrd");
  if (first.starts_with(npy)) return format_of_name(".npy");
  const auto begins_so = [first](std::string_view magic) { return first.starts_with(magic); };
  return std::any_of(nifti.begin(), nifti.end(), begins_so) ? format_of_name(".nii") : nullptr;
}

}  // namespace

std::span<const VolumeFormat> volume_formats() {
  static constexpr std::array formats{
      VolumeFormat{".nrrd", read_nrrd_header}, VolumeFormat{".nhdr", read_nrrd_header},
      VolumeFormat{".nii", read_nifti_header}, VolumeFormat{".nii.gz", read_nifti_header},
      VolumeFormat{".hdr", read_nifti_header}, VolumeFormat{".npy", read_npy_header},
  };
  return formats;
}

const VolumeFormat* format_of_name(std::string_view file_name) {
  const auto found = std::find_if(
      volume_formats().begin(), volume_formats().end(),
      [file_name](const VolumeFormat& format) { return boost::algorithm::iends_with(file_name, format.extension); });
  return found == volume_formats().end() ? nullptr : &*found;
}

StoredVolume read_volume_header(const std::filesystem::path& file, const VolumeChoices& choices) {
  if (const auto* const format = format_of_name(file.filename().string())) return format->read_header(file, choices);
  if (const auto* const format = format_of_content(file)) {
    StoredVolume stored = format->read_header(file, choices);
    stored.volume.warnings.push_back(
        fmt::format("the name does not tell the format; the first bytes are those of {}", stored.volume.format));
    return stored;
  }
  std::vector<std::string_view> known;
  for (const VolumeFormat& format : volume_formats()) known.push_back(format.extension);
  const std::string_view last = known.back();
  known.pop_back();
  refuse(file, "neither the name nor the first bytes tell the format",
         fmt::format("{} and {} are allowed", fmt::join(known, ", "), last));
}

Volume read_volume(const std::filesystem::path& file, const VolumeChoices& choices, std::uint64_t memory_limit) {
  return read_voxels(read_volume_header(file, choices), choices, memory_limit);
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
