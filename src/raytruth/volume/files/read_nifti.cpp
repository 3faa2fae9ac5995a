#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nifti1_io.h>
#include <nifti2.h>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

// libnifti defines the headers and knows their types. It is not given the file: it would mend what is wrong in silence
// (sizes, spacing, a scaling that is not finite) and print what it cannot mend. What it mends is mended here, aloud.

namespace raytruth {
namespace {

/// What is needed of a header of either version.
struct Header {
  int version = 1;
  std::string magic;
  std::array<std::int64_t, 8> dim{};
  int datatype = 0;
  int bitpix = 0;
  std::array<double, 8> pixdim{};
  double vox_offset = 0;
  double scl_slope = 0;
  double scl_inter = 0;
  int units = 0;
  int sform_code = 0;
  std::array<std::array<double, 4>, 3> sform{};

  /// The bytes of the header and of the four that say whether extensions follow.
  [[nodiscard]] int bytes() const { return version == 1 ? 352 : 544; }
};

/// `Raw` is the header as the file has it, but for its order of bytes.
template <class Raw>
Header understood(const Raw& raw, int version) {
  Header header{.version = version,
                .magic = std::string(raw.magic, strnlen(raw.magic, sizeof(raw.magic))),
                .datatype = raw.datatype,
                .bitpix = raw.bitpix,
                .vox_offset = static_cast<double>(raw.vox_offset),
                .scl_slope = raw.scl_slope,
                .scl_inter = raw.scl_inter,
                .units = raw.xyzt_units,
                .sform_code = raw.sform_code};
  std::copy(std::begin(raw.dim), std::end(raw.dim), header.dim.begin());
  std::copy(std::begin(raw.pixdim), std::end(raw.pixdim), header.pixdim.begin());
  std::copy(std::begin(raw.srow_x), std::end(raw.srow_x), header.sform[0].begin());
  std::copy(std::begin(raw.srow_y), std::end(raw.srow_y), header.sform[1].begin());
  std::copy(std::begin(raw.srow_z), std::end(raw.srow_z), header.sform[2].begin());
  return header;
}

/// Turns the bytes of the numbers that are needed; libnifti does so for version 1 alone.
void swap_header(nifti_2_header& raw) {
  for (void* number : {static_cast<void*>(&raw.datatype), static_cast<void*>(&raw.bitpix)})
    nifti_swap_2bytes(1, number);
  for (void* number : {static_cast<void*>(&raw.sform_code), static_cast<void*>(&raw.xyzt_units)})
    nifti_swap_4bytes(1, number);
  for (void* number :
       {static_cast<void*>(&raw.vox_offset), static_cast<void*>(&raw.scl_slope), static_cast<void*>(&raw.scl_inter)})
    nifti_swap_8bytes(1, number);
  nifti_swap_8bytes(std::size(raw.dim), raw.dim);
  nifti_swap_8bytes(std::size(raw.pixdim), raw.pixdim);
  for (void* row : {static_cast<void*>(raw.srow_x), static_cast<void*>(raw.srow_y), static_cast<void*>(raw.srow_z)})
    nifti_swap_8bytes(std::size(raw.srow_x), row);
}

/// The header in this machine's byte order; `volume` learns the file's.
Header read_header(Volume& volume) {
  const auto& file = volume.file;
  constexpr int size_in_nifti_1 = sizeof(nifti_1_header);
  constexpr int size_in_nifti_2 = sizeof(nifti_2_header);
  std::array<unsigned char, sizeof(nifti_2_header)> bytes{};
  ByteStream stream(file, 0, volume.encoding == Encoding::gzip);
  const auto length = stream.read(bytes);
  if (length < sizeof(nifti_1_header)) {
    refuse(file, fmt::format("the file ends after {} bytes", length), "a NIfTI header has 348 or 540");
  }
  int size = 0;
  std::memcpy(&size, bytes.data(), sizeof(size));
  int turned = size;
  nifti_swap_4bytes(1, &turned);
  const auto is_size = [](int number) { return number == size_in_nifti_1 || number == size_in_nifti_2; };
  const bool is_turned = !is_size(size) && is_size(turned);
  if (is_turned) {
    size = turned;
    volume.endian = std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
  }
  if (size == size_in_nifti_1) {
    nifti_1_header raw{};
    std::memcpy(&raw, bytes.data(), sizeof(raw));
    if (is_turned) swap_nifti_header(&raw, 1);
    return understood(raw, 1);
  }
  if (size != size_in_nifti_2) refuse(file, "this is not NIfTI", "NIfTI is allowed: its first number is 348 or 540");
  if (length < bytes.size()) {
    refuse(file, fmt::format("the file ends after {} bytes", length), "a header of NIfTI-2 has 540");
  }
  nifti_2_header raw{};
  std::memcpy(&raw, bytes.data(), sizeof(raw));
  if (is_turned) swap_header(raw);
  return understood(raw, 2);
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
             fmt::format("integer and floating types of at most 8 bytes are allowed; {}", npy_is_the_way_in));
  }
}

/// value = scl_slope * stored + scl_inter, unless scl_slope is 0 (nifti1.h, "DATA SCALING") or no number.
void set_scaling(Volume& volume, const Header& header) {
  if (!std::isfinite(header.scl_slope)) {
    volume.warnings.push_back(
        fmt::format("scl_slope is {}; the voxels are read unscaled, as libnifti and nibabel do", header.scl_slope));
    return;
  }
  if (header.scl_slope == 0) return;
  volume.slope = header.scl_slope;
  if (std::isfinite(header.scl_inter)) {
    volume.intercept = header.scl_inter;
  } else {
    volume.warnings.push_back(fmt::format("scl_inter is {}; 0 is taken, as libnifti does", header.scl_inter));
  }
}

/// How long a step of time takes, with its unit where the header states one.
std::string duration(const Header& header) {
  constexpr int mask_of_time = 0x38;
  const double step = header.pixdim[4];
  switch (header.units & mask_of_time) {
    case NIFTI_UNITS_SEC:
      return fmt::format("{} s", step);
    case NIFTI_UNITS_MSEC:
      return fmt::format("{} ms", step);
    case NIFTI_UNITS_USEC:
      return fmt::format("{} us", step);
    case 0:
      return fmt::format("{} (of no stated unit)", step);
    default:
      return fmt::format("{} (not of time: unit {})", step, header.units & mask_of_time);
  }
}

/// The first three axes are of space, the fourth of time, and further ones of whatever the file is about.
std::vector<StoredAxis> axes(Volume& volume, const Header& header) {
  const auto count = header.dim[0];
  if (count < 1 || count > 7) {
    refuse(volume.file, fmt::format("dim[0], the number of axes, is {}", count), "1 to 7 are allowed");
  }
  constexpr std::size_t time = 4;
  std::vector<StoredAxis> result;
  for (std::size_t axis = 1; axis <= static_cast<std::size_t>(count); ++axis) {
    auto size = header.dim[axis];
    if (size == 0 && axis >= time) {
      volume.warnings.push_back(fmt::format("the size dim[{}] is 0; 1 is taken, as libnifti does", axis));
      size = 1;
    }
    if (size < 1) {
      refuse(volume.file, fmt::format("the size dim[{}] is {}", axis, size), "sizes >= 1 are allowed");
    }
    StoredAxis& added = result.emplace_back(StoredAxis{.size = static_cast<std::uint64_t>(size)});
    if (axis < time) {
      added.spacing = header.pixdim[axis];
      if (added.spacing == 0 || !std::isfinite(added.spacing)) {
        volume.warnings.push_back(fmt::format("pixdim[{}] is {}; 1 is taken, as libnifti does", axis, added.spacing));
        added.spacing = 1;
      }
    } else if (axis == time) {
      added.kind = StoredAxis::Kind::time;
      added.what = fmt::format("axis 4 is time, {} steps of {}", size, duration(header));
    } else {
      added.kind = StoredAxis::Kind::other;
      added.what = fmt::format("axis {} holds {} numbers for each voxel", axis, size);
    }
  }
  return result;
}

/// Warns where the matrix that places the voxels in the world is no rotation of the stated spacing.
void check_sform(Volume& volume, const Header& header) {
  if (header.sform_code <= 0) return;
  std::vector<std::vector<double>> columns;
  std::array<double, 3> lengths{};
  std::array<double, 3> stated{};
  bool agree = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    columns.push_back({header.sform[0][axis], header.sform[1][axis], header.sform[2][axis]});
    lengths[axis] = std::hypot(columns[axis][0], columns[axis][1], columns[axis][2]);
    stated[axis] = std::abs(header.pixdim[axis + 1]);
    constexpr double tolerance = 1e-3;
    const bool is_used = static_cast<std::int64_t>(axis) < header.dim[0] && header.dim[axis + 1] > 1;
    if (is_used && !(std::abs(lengths[axis] - stated[axis]) <= tolerance * stated[axis])) agree = false;
  }
  if (!agree) {
    volume.warnings.push_back(fmt::format("pixdim states the spacing {}, and the sform {}; the first is taken",
                                          fmt::join(stated, " "), fmt::join(lengths, " ")));
  }
  if (auto warning = shear_warning(columns, "the axes of the sform")) volume.warnings.push_back(std::move(*warning));
}

/// The file of the voxels beside a header, in whichever case its name is written.
std::filesystem::path image_beside(const std::filesystem::path& header) {
  std::error_code none;
  const bool is_upper = header.extension() == ".HDR";
  auto image = header;
  for (const auto* extension : {is_upper ? ".IMG" : ".img", is_upper ? ".img" : ".IMG"}) {
    image.replace_extension(extension);
    if (std::filesystem::exists(image, none)) return image;
    for (const auto* packed : {".gz", ".GZ"}) {
      if (std::filesystem::exists(image.string() + packed, none)) return image.string() + packed;
    }
  }
  return image.replace_extension(".img");
}

/// Where the voxels lie: after the header, or in the .img (or .img.gz) beside a .hdr.
StoredVolume::Share data_file(Volume& volume, const Header& header) {
  const bool one_file = !boost::algorithm::iequals(volume.file.extension().string(), ".hdr");
  const auto needed = fmt::format("n{}{}", one_file ? '+' : 'i', header.version);
  const auto other = fmt::format("n{}{}", one_file ? 'i' : '+', header.version);
  if (std::string_view(header.magic).substr(0, needed.size()) != needed) {
    refuse(volume.file, fmt::format("the magic is \"{}\"", printable(header.magic)),
           fmt::format("\"{}\" is allowed in {}, \"{}\" in {}", needed, one_file ? ".nii" : ".hdr", other,
                       one_file ? ".hdr" : ".nii"));
  }
  const int least = one_file ? header.bytes() : 0;
  constexpr double most = 9e15;
  const double begin = header.vox_offset;
  if (!(begin >= least && begin <= most && begin == std::floor(begin))) {
    refuse(volume.file, fmt::format("vox_offset is {}", begin),
           fmt::format("a whole number of at least {} bytes is allowed", least));
  }
  StoredVolume::Share share{volume.file, 0, static_cast<std::uint64_t>(begin)};
  if (!one_file) {
    share.file = image_beside(volume.file);
    volume.encoding = boost::algorithm::iends_with(share.file.string(), ".gz") ? Encoding::gzip : Encoding::raw;
  }
  return share;
}

}  // namespace

StoredVolume read_nifti_header(const std::filesystem::path& file, const VolumeChoices& choices) {
  StoredVolume stored;
  auto& volume = stored.volume;
  volume.file = file;
  const bool is_named_gzip = boost::algorithm::iends_with(file.string(), ".gz");
  volume.encoding = is_gzip_file(file) ? Encoding::gzip : Encoding::raw;
  if ((volume.encoding == Encoding::gzip) != is_named_gzip) {
    volume.warnings.emplace_back(is_named_gzip ? "the name says gzip, and the bytes are not; they are read as they are"
                                               : "the bytes are gzip, and the name does not say so; they are inflated");
  }
  const auto header = read_header(volume);
  volume.format = header.version == 1 ? "NIfTI-1" : "NIfTI-2";
  stored.shares = {data_file(volume, header)};
  volume.type = voxel_type(file, header.datatype);
  if (header.bitpix != 8 * facts(volume.type).bytes) {
    volume.warnings.push_back(fmt::format("bitpix is {}; the datatype {} says {}, as libnifti and nibabel have it",
                                          header.bitpix, facts(volume.type).name, 8 * facts(volume.type).bytes));
  }
  set_axes(stored, axes(volume, header), choices);
  check_sform(volume, header);
  set_scaling(volume, header);
  return stored;
}

}  // namespace raytruth
