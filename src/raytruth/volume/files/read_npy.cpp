#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

// NumPy's own format (numpy.lib.format): a magic, a version, the length of the header, and the header, a Python dict
// such as {'descr': '<f4', 'fortran_order': False, 'shape': (93, 64, 64), }.

namespace raytruth {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::string_view blanks = " \t\r\n";

struct Header {
  std::string text;
  std::uint64_t end = 0;  ///< where the numbers begin
};

Header read_text_of_header(const std::filesystem::path& file, bool gzip) {
  constexpr std::string_view allowed = "a NumPy file of version 1, 2 or 3 is allowed";
  constexpr std::size_t longest = std::size_t{1} << 20U;
  ByteStream stream(file, 0, gzip);
  std::array<unsigned char, 8> start{};
  const auto length = stream.read(start);
  if (length < start.size() || !std::equal(magic.begin(), magic.end(), reinterpret_cast<const char*>(start.data()))) {
    refuse(file, "this is not a NumPy file", allowed);
  }
  const int version = start[magic.size()];
  if (version < 1 || version > 3) refuse(file, fmt::format("the version is {}", version), allowed);
  // The length is little endian, and of two bytes in version 1.
  std::array<unsigned char, 4> size_bytes{};
  const std::size_t width = version == 1 ? 2 : 4;
  if (stream.read(std::span(size_bytes).first(width)) < width) refuse(file, "the header has no end", allowed);
  std::size_t size = 0;
  for (std::size_t byte = 0; byte < width; ++byte) size |= std::size_t{size_bytes[byte]} << (8 * byte);
  if (size > longest) refuse(file, fmt::format("the header has {} bytes", size), "at most 1 MiB is allowed");
  std::vector<unsigned char> text(size);
  if (stream.read(text) < size) refuse(file, "the header has no end", allowed);
  return {std::string(text.begin(), text.end()), start.size() + width + size};
}

/// What follows the key in the dict, from its first character on; throws InputError where the key is not there.
std::string_view value_of(const std::filesystem::path& file, std::string_view text, std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const auto quoted = fmt::format("{}{}{}", quote, key, quote);
    auto place = text.find(quoted);
    if (place == std::string_view::npos) continue;
    place = text.find_first_not_of(blanks, place + quoted.size());
    if (place == std::string_view::npos || text[place] != ':') continue;
    place = text.find_first_not_of(blanks, place + 1);
    if (place != std::string_view::npos) return text.substr(place);
  }
  refuse(file, fmt::format("the header has no \"{}\"", key), "a NumPy header needs it");
}

/// NumPy's name of a type: its order of bytes, its kind and its bytes.
void set_type(Volume& volume, std::string_view text) {
  struct Row {
    std::string_view name;
    VoxelType type;
  };
  constexpr std::array<Row, 11> types{{{"b1", VoxelType::uint8},
                                       {"i1", VoxelType::int8},
                                       {"u1", VoxelType::uint8},
                                       {"i2", VoxelType::int16},
                                       {"u2", VoxelType::uint16},
                                       {"i4", VoxelType::int32},
                                       {"u4", VoxelType::uint32},
                                       {"i8", VoxelType::int64},
                                       {"u8", VoxelType::uint64},
                                       {"f4", VoxelType::float32},
                                       {"f8", VoxelType::float64}}};
  const auto refuse_type = [&volume](std::string_view found) {
    refuse(volume.file, fmt::format("the type is {}", printable(found)),
           "numbers of 8 to 64 bits, integer or floating, are allowed: array.astype(\"float32\") makes them");
  };
  const char quote = text.front();
  const auto end = quote == '\'' || quote == '"' ? text.find(quote, 1) : std::string_view::npos;
  if (end == std::string_view::npos) refuse_type(text.substr(0, text.find('\n')));
  const auto descr = text.substr(1, end - 1);
  const auto row = std::find_if(types.begin(), types.end(), [descr](const Row& candidate) {
    return descr.size() == 3 && descr.substr(1) == candidate.name;
  });
  const bool has_order = !descr.empty() && std::string_view("<>|=").find(descr.front()) != std::string_view::npos;
  if (row == types.end() || !has_order) refuse_type(text.substr(0, end + 1));
  volume.type = row->type;
  if (descr.front() == '<') volume.endian = std::endian::little;
  if (descr.front() == '>') volume.endian = std::endian::big;
}

bool is_in_fortran_order(const std::filesystem::path& file, std::string_view text) {
  if (text.starts_with("True")) return true;
  if (text.starts_with("False")) return false;
  refuse(file, fmt::format("\"fortran_order\" is {}", printable(text.substr(0, text.find(',')))),
         "True and False are allowed");
}

std::vector<std::uint64_t> shape_of(const std::filesystem::path& file, std::string_view text) {
  const auto end = text.find(')');
  const auto refuse_shape = [&] {
    refuse(file, fmt::format("\"shape\" is {}", printable(text.substr(0, end))),
           "a tuple (z, y, x) of whole numbers is allowed");
  };
  if (text.front() != '(' || end == std::string_view::npos) refuse_shape();
  std::vector<std::uint64_t> shape;
  auto rest = text.substr(1, end - 1);
  while (rest.find_first_not_of(blanks) != std::string_view::npos) {
    auto word = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    word.remove_prefix(std::min(word.find_first_not_of(blanks), word.size()));
    word = word.substr(0, word.find_last_not_of(blanks) + 1);
    std::uint64_t size = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), size);
    if (error != std::errc() || last != word.data() + word.size()) refuse_shape();
    shape.push_back(size);
  }
  return shape;
}

}  // namespace

StoredVolume read_npy_header(const std::filesystem::path& file, const VolumeChoices& choices) {
  StoredVolume stored;
  auto& volume = stored.volume;
  volume.file = file;
  volume.format = "NPY";
  volume.encoding = is_gzip_file(file) ? Encoding::gzip : Encoding::raw;
  volume.has_spacing = false;
  const auto header = read_text_of_header(file, volume.encoding == Encoding::gzip);
  set_type(volume, value_of(file, header.text, "descr"));
  stored.is_z_fastest = is_in_fortran_order(file, value_of(file, header.text, "fortran_order"));
  // Axes are x, y, z; where the numbers lie in Fortran's order, read_voxels turns them.
  const auto shape = shape_of(file, value_of(file, header.text, "shape"));
  if (shape.size() < 3) {
    refuse(file, fmt::format("the array has {} axes", shape.size()), "three, (z, y, x), are allowed");
  }
  std::vector<StoredAxis> axes;
  std::transform(shape.rbegin(), shape.rend(), std::back_inserter(axes),
                 [](std::uint64_t size) { return StoredAxis{.size = size}; });
  set_axes(stored, axes, choices);
  stored.shares = {{file, 0, header.end}};
  return stored;
}

}  // namespace raytruth
