#include <fmt/format.h>
#include <nifti1_io.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

// libnifti defines the header, turns its bytes and knows its types. It is not given the file: it would mend what is
// wrong in silence (sizes, spacing, a scaling that is not finite) and print what it cannot mend.

namespace raytruth {
namespace {

constexpr std::string_view name_one_file = "n+1";
constexpr std::string_view name_two_files = "ni1";
constexpr double header_and_extender = 352;

/// The header in this machine's byte order; `volume` learns the file's.
nifti_1_header read_header(Volume& volume) {
  const auto& file = volume.file;
  std::array<unsigned char, sizeof(nifti_1_header)> bytes{};
  ByteStream stream(file, 0, volume.encoding == Encoding::gzip);
  const auto length = stream.read(bytes);
  if (length < bytes.size()) {
    refuse(file, fmt::format("the file ends after {} bytes", length), "a NIfTI-1 header has 348");
  }
  auto header = std::bit_cast<nifti_1_header>(bytes);
  constexpr int header_size = sizeof(nifti_1_header);
  if (header.sizeof_hdr != header_size) {
    auto turned = header;
    swap_nifti_header(&turned, 1);
    if (turned.sizeof_hdr != header_size) {
      constexpr int size_in_nifti_2 = 540;
      const bool is_nifti_2 = header.sizeof_hdr == size_in_nifti_2 || turned.sizeof_hdr == size_in_nifti_2;
      refuse(file, is_nifti_2 ? "this is NIfTI-2" : "this is not NIfTI", "NIfTI-1 is allowed: its first number is 348");
    }
    header = turned;
    volume.endian = std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
  }
  return header;
}

VoxelType voxel_type(const std::filesystem::path& file, int type) {
  switch (type) {
    case NIFTI_TYPE_INT8:
      return VoxelType::int8;
    case NIFTI_TYPE_UINT8:
      return VoxelType::uint8;
    case NIFTI_TYPE_INT16:
      return VoxelType::int16;
    case NIFTI_TYPE_UINT16:
      return VoxelType::uint16;
    case NIFTI_TYPE_INT32:
      return VoxelType::int32;
    case NIFTI_TYPE_UINT32:
      return VoxelType::uint32;
    case NIFTI_TYPE_INT64:
      return VoxelType::int64;
    case NIFTI_TYPE_UINT64:
      return VoxelType::uint64;
    case NIFTI_TYPE_FLOAT32:
      return VoxelType::float32;
    case NIFTI_TYPE_FLOAT64:
      return VoxelType::float64;
    default:
      refuse(file, fmt::format("the datatype is {} ({})", type, nifti_datatype_string(type)),
             "integer and floating types of at most 8 bytes are allowed");
  }
}

/// value = scl_slope * stored + scl_inter, unless scl_slope is 0 (nifti1.h, "DATA SCALING").
void set_scaling(Volume& volume, const nifti_1_header& header) {
  if (!std::isfinite(header.scl_slope)) {
    refuse(volume.file, fmt::format("scl_slope is {}", header.scl_slope),
           "a finite number is allowed, 0 for no scaling");
  }
  if (header.scl_slope == 0) return;
  if (!std::isfinite(header.scl_inter)) {
    refuse(volume.file, fmt::format("scl_inter is {}", header.scl_inter), "a finite number is allowed");
  }
  volume.slope = header.scl_slope;
  volume.intercept = header.scl_inter;
}

std::vector<StoredAxis> axes(const Volume& volume, const nifti_1_header& header) {
  const int count = header.dim[0];
  if (count < 1 || count > 7) {
    refuse(volume.file, fmt::format("dim[0], the number of axes, is {}", count), "1 to 7 are allowed");
  }
  std::vector<StoredAxis> result;
  for (std::size_t axis = 1; axis <= static_cast<std::size_t>(count); ++axis) {
    if (header.dim[axis] < 1) {
      refuse(volume.file, fmt::format("the size dim[{}] is {}", axis, header.dim[axis]), "sizes >= 1 are allowed");
    }
    result.push_back({static_cast<std::uint64_t>(header.dim[axis]), header.pixdim[axis]});
  }
  return result;
}

/// Where the voxels lie: after the header, or in the .img (or .img.gz) beside a .hdr.
StoredVolume::Share data_file(Volume& volume, const nifti_1_header& header) {
  const std::string_view magic(header.magic, strnlen(header.magic, sizeof(header.magic)));
  const bool one_file = volume.file.extension() != ".hdr";
  if (magic != (one_file ? name_one_file : name_two_files)) {
    refuse(volume.file, fmt::format("the magic is \"{}\"", printable(magic)),
           R"("n+1" is allowed in .nii, "ni1" in .hdr)");
  }
  const double least = one_file ? header_and_extender : 0;
  constexpr double most = 9e15;
  const double begin = header.vox_offset;
  if (!(begin >= least && begin <= most && begin == std::floor(begin))) {
    refuse(volume.file, fmt::format("vox_offset is {}", begin),
           fmt::format("a whole number of at least {} bytes is allowed", least));
  }
  StoredVolume::Share share{volume.file, 0, static_cast<std::uint64_t>(begin)};
  if (!one_file) {
    std::error_code none;
    share.file.replace_extension(".img");
    if (!std::filesystem::exists(share.file, none) && std::filesystem::exists(share.file.string() + ".gz", none)) {
      share.file += ".gz";
      volume.encoding = Encoding::gzip;
    }
  }
  return share;
}

}  // namespace

StoredVolume read_nifti_header(const std::filesystem::path& file) {
  StoredVolume stored;
  auto& volume = stored.volume;
  volume.file = file;
  volume.format = "NIfTI-1";
  volume.encoding = file.extension() == ".gz" ? Encoding::gzip : Encoding::raw;
  const auto header = read_header(volume);
  stored.shares = {data_file(volume, header)};
  volume.type = voxel_type(file, header.datatype);
  if (header.bitpix != 8 * facts(volume.type).bytes) {
    refuse(file, fmt::format("bitpix is {}", header.bitpix),
           fmt::format("{} is allowed for {}", 8 * facts(volume.type).bytes, facts(volume.type).name));
  }
  set_axes(volume, axes(volume, header));
  set_scaling(volume, header);
  return stored;
}

}  // namespace raytruth
