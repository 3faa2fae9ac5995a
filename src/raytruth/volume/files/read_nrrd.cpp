#include <fmt/format.h>
#include <teem/nrrd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

namespace raytruth {
namespace {

/// The fields that say how to read the voxels; the others are passed over.
constexpr std::array fields_of_use{
    nrrdField_type,     nrrdField_dimension, nrrdField_space,     nrrdField_space_dimension,  nrrdField_sizes,
    nrrdField_spacings, nrrdField_axis_mins, nrrdField_axis_maxs, nrrdField_space_directions, nrrdField_centers,
    nrrdField_kinds,    nrrdField_endian,    nrrdField_encoding,  nrrdField_line_skip,        nrrdField_byte_skip,
    nrrdField_data_file};

/// A header, taken apart into its lines.
struct Header {
  std::string magic;
  std::map<int, std::string> fields;        // by Teem's number of the field
  std::vector<std::string> listed_files;    // the lines after "data file: LIST"
  std::optional<std::uint64_t> data_begin;  // after the empty line, if there is one

  [[nodiscard]] std::string field(int number) const {
    const auto found = fields.find(number);
    return found == fields.end() ? "" : found->second;
  }
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

void add_field(Header& header, const std::filesystem::path& file, std::string_view line, int line_number) {
  const auto colon = std::min(line.find(": "), line.size());
  const int field = airEnumVal(nrrdField, std::string(line.substr(0, colon)).c_str());
  if (field == nrrdField_unknown || colon == line.size()) {
    if (line.find(":=") != std::string_view::npos) return;
    refuse(file, fmt::format("line {} of the header is \"{}\"", line_number, printable(line)),
           R"("field: value" with a field of the NRRD format, "key:=value" and comments are allowed)");
  }
  if (std::find(fields_of_use.begin(), fields_of_use.end(), field) == fields_of_use.end()) return;
  if (!header.fields.emplace(field, trimmed(line.substr(colon + 2))).second) {
    refuse(file, fmt::format("the field \"{}\" stands twice in the header", airEnumStr(nrrdField, field)),
           "once is allowed");
  }
}

bool is_magic(std::string_view line) {
  return line == "NRRD00.01" ||
         (line.size() == 8 && line.starts_with("NRRD000") && line.back() >= '1' && line.back() <= '6');
}

Header read_lines(const std::filesystem::path& file) {
  constexpr std::size_t longest = std::size_t{1} << 20U;
  std::vector<unsigned char> bytes(longest);
  ByteStream stream(file);
  const std::size_t length = stream.read(bytes);
  const bool is_whole_file = length == stream.most_bytes();
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), length);

  Header header;
  for (int number = 1; !text.empty(); ++number) {
    const auto end = std::min(text.find('\n'), text.size());
    if (end == text.size() && !is_whole_file) {
      refuse(file, "the header has no end", "a header of at most 1 MiB is allowed");
    }
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) {
      header.data_begin = length - text.size();
      break;
    }
    if (line.find('\0') != std::string_view::npos || (number == 1 && !is_magic(line))) {
      refuse(file, fmt::format("line {} of the header is \"{}\"", number, printable(line)),
             R"(text is allowed, with "NRRD0001" to "NRRD0006" as its first line)");
    }
    if (number == 1) {
      header.magic = line;
    } else if (header.field(nrrdField_data_file).starts_with("LIST")) {
      header.listed_files.emplace_back(line);
    } else if (line.front() != '#') {
      add_field(header, file, line, number);
    }
  }
  for (const int needed : {nrrdField_type, nrrdField_dimension, nrrdField_sizes, nrrdField_encoding}) {
    if (!header.fields.contains(needed)) {
      refuse(file, fmt::format("the header has no field \"{}\"", airEnumStr(nrrdField, needed)),
             "an NRRD header needs it");
    }
  }
  return header;
}

/// What is between blanks, brackets and commas.
std::vector<std::string> words(std::string text) {
  const auto separates = [](char character) { return character == '(' || character == ')' || character == ','; };
  std::replace_if(text.begin(), text.end(), separates, ' ');
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// The number that is all of `word`; nothing if it is none or too large for its type.
template <class Number>
std::optional<Number> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

/// Looks at the fields before Teem does. Teem takes "2x" for 2, "banana" for an unknown number (there is "nan" in it)
/// and sizes modulo 2^64, and writes its complaints, with the field in them, into a buffer of 1024 characters.
void check_fields(const std::filesystem::path& file, const Header& header) {
  constexpr std::size_t longest = 500;
  for (const auto& [field, value] : header.fields) {
    const auto refuse_value = [&, &field = field, &value = value](std::string_view allowed) {
      refuse(file, fmt::format("the field \"{}\" is \"{}\"", airEnumStr(nrrdField, field), printable(value)), allowed);
    };
    if (value.size() > longest) refuse_value("at most 500 characters are allowed");
    switch (field) {
      case nrrdField_sizes: {
        std::vector<std::uint64_t> sizes;
        for (const auto& word : words(value)) sizes.push_back(number<std::uint64_t>(word).value_or(0));
        check_sizes(file, sizes, printable(value));
        break;
      }
      case nrrdField_dimension:
      case nrrdField_space_dimension:
      case nrrdField_line_skip:
      case nrrdField_byte_skip:
        if (!number<std::int64_t>(value)) refuse_value("a whole number is allowed");
        break;
      case nrrdField_spacings:
      case nrrdField_axis_mins:
      case nrrdField_axis_maxs:
      case nrrdField_space_directions:
        for (const auto& word : words(value)) {
          if (word != "none" && !number<double>(word)) refuse_value("numbers are allowed");
        }
        break;
      default:
        break;
    }
  }
}

using OwnedNrrd = std::unique_ptr<Nrrd, Nrrd* (*)(Nrrd*)>;
using OwnedState = std::unique_ptr<NrrdIoState, NrrdIoState* (*)(NrrdIoState*)>;

/// Teem's complaint: the innermost line of its stack of messages, without the names of its functions.
std::string complaint_of_teem() {
  const std::unique_ptr<char, decltype(&std::free)> stack(biffGetDone(nrrdBiffKey), std::free);
  std::string_view text(stack ? stack.get() : "");
  while (text.ends_with('\n')) text.remove_suffix(1);
  text.remove_prefix(std::min(text.rfind('\n') + 1, text.size()));
  if (const auto colon = text.find(": "); colon != std::string_view::npos) text.remove_prefix(colon + 2);
  return printable(text);
}

/// Teem fills `nrrd` and `state` from the header. It opens no file, nor sees the names of data files, which it would
/// give to printf as a format.
void parse(const std::filesystem::path& file, const Header& header, Nrrd& nrrd, NrrdIoState& state) {
  std::string text = header.magic + '\n';
  const bool has_directions = header.fields.contains(nrrdField_space_directions);
  for (const int field : fields_of_use) {  // in this order: some need one before them
    // Teem refuses ends of axes beside directions, which say more.
    if (has_directions && (field == nrrdField_axis_mins || field == nrrdField_axis_maxs)) continue;
    if (field != nrrdField_data_file && header.fields.contains(field)) {
      text += fmt::format("{}: {}\n", airEnumStr(nrrdField, field), header.field(field));
    }
  }
  static std::mutex messages_of_teem;
  const std::scoped_lock lock(messages_of_teem);
  nrrdStateVerboseIO = 0;
  state.skipData = 1;
  if (nrrdStringRead(&nrrd, text.c_str(), &state) != 0) {
    refuse(file, "the NRRD header is not valid: " + complaint_of_teem(), "what the format defines is allowed");
  }
}

VoxelType voxel_type(const std::filesystem::path& file, const std::string& type) {
  switch (airEnumVal(nrrdType, type.c_str())) {
    case nrrdTypeChar:
      return VoxelType::int8;
    case nrrdTypeUChar:
      return VoxelType::uint8;
    case nrrdTypeShort:
      return VoxelType::int16;
    case nrrdTypeUShort:
      return VoxelType::uint16;
    case nrrdTypeInt:
      return VoxelType::int32;
    case nrrdTypeUInt:
      return VoxelType::uint32;
    case nrrdTypeLLong:
      return VoxelType::int64;
    case nrrdTypeULLong:
      return VoxelType::uint64;
    case nrrdTypeFloat:
      return VoxelType::float32;
    case nrrdTypeDouble:
      return VoxelType::float64;
    default:
      refuse(file, fmt::format("the type is \"{}\"", printable(type)),
             fmt::format("integer and floating types are allowed; {}", npy_is_the_way_in));
  }
}

Encoding encoding(const std::filesystem::path& file, const std::string& encoding) {
  switch (airEnumVal(nrrdEncodingType, encoding.c_str())) {
    case nrrdEncodingTypeRaw:
      return Encoding::raw;
    case nrrdEncodingTypeGzip:
      return Encoding::gzip;
    case nrrdEncodingTypeAscii:
      return Encoding::ascii;
    default:
      refuse(file, fmt::format("the encoding is \"{}\"", printable(encoding)),
             fmt::format("raw, gzip and ascii are allowed; {}", npy_is_the_way_in));
  }
}

using Direction = std::array<double, NRRD_SPACE_DIM_MAX>;

bool has_direction(const Nrrd& nrrd, unsigned axis) {
  return nrrd.spaceDim > 0 && AIR_EXISTS(nrrd.axis[axis].spaceDirection[0]);
}

/// What the ends of an axis make its spacing: centres of voxels stand on them (node), or they are the outer faces of
/// voxels (cell), which is meant where the header does not say, as Teem has it. Nothing where it gives no two ends.
std::optional<double> spacing_between_ends(const Nrrd& nrrd, unsigned axis) {
  const auto& info = nrrd.axis[axis];
  if (!AIR_EXISTS(info.min) || !AIR_EXISTS(info.max)) return std::nullopt;
  const bool is_node = info.center == nrrdCenterNode && info.size > 1;
  return (info.max - info.min) / static_cast<double>(is_node ? info.size - 1 : info.size);
}

/// Distance of neighbours along an axis: its spacing, the length of its direction or what its ends make of it. Nothing
/// if the header gives none.
std::optional<double> spacing(const Nrrd& nrrd, unsigned axis, Volume& volume) {
  double distance = 1;
  Direction direction{};
  const int status = nrrdSpacingCalculate(&nrrd, axis, &distance, direction.data());
  const auto between_ends = spacing_between_ends(nrrd, axis);
  if (status == nrrdSpacingStatusNone || status == nrrdSpacingStatusUnknown || std::isnan(distance)) {
    if (between_ends && nrrd.axis[axis].center == nrrdCenterUnknown) {
      volume.warnings.push_back(fmt::format(
          "\"axis mins\" and \"axis maxs\" give axis {} an extent, and no \"centers\" say of what; outer faces "
          "of voxels are taken, which makes the spacing {}",
          axis, *between_ends));
    }
    return between_ends;
  }
  constexpr double tolerance = 1e-3;
  if (between_ends && std::abs(std::abs(*between_ends) - std::abs(distance)) > tolerance * std::abs(distance)) {
    volume.warnings.push_back(
        fmt::format("axis {} has the spacing {}, and {} by \"axis mins\" and \"axis maxs\"; the first is taken", axis,
                    distance, *between_ends));
  }
  return distance;
}

/// Warns where directions are not perpendicular: a grid of boxes is all that follows knows.
void warn_of_shear(const Nrrd& nrrd, Volume& volume) {
  std::vector<std::vector<double>> directions;
  for (unsigned axis = 0; axis < nrrd.dim; ++axis) {
    if (!has_direction(nrrd, axis)) continue;
    const auto* const direction = nrrd.axis[axis].spaceDirection;
    directions.emplace_back(direction, direction + nrrd.spaceDim);
  }
  if (auto warning = shear_warning(directions, "the space directions")) volume.warnings.push_back(std::move(*warning));
}

/// What an axis is, by its kind and its direction.
StoredAxis stored_axis(const Nrrd& nrrd, unsigned axis, Volume& volume) {
  const auto& info = nrrd.axis[axis];
  StoredAxis result{.size = info.size};
  const std::string kind = info.kind == nrrdKindUnknown ? "" : airEnumStr(nrrdKind, info.kind);
  if (info.kind == nrrdKindTime || info.kind == nrrdKindList) {
    result.kind = StoredAxis::Kind::time;
    result.what = fmt::format("axis {} has the kind {}: it holds {} volumes", axis, kind, info.size);
    return result;
  }
  if (info.kind != nrrdKindUnknown && nrrdKindIsDomain(info.kind) == 0) {
    result.kind = StoredAxis::Kind::other;
    result.what = fmt::format("axis {} holds the {} parts of a {}", axis, info.size, kind);
    return result;
  }
  if (nrrd.spaceDim > 0 && !has_direction(nrrd, axis)) {
    result.kind = StoredAxis::Kind::other;
    result.what =
        fmt::format("axis {} has the direction none, so it is no axis of space, and its size is {}", axis, info.size);
    return result;
  }
  const auto distance = spacing(nrrd, axis, volume);
  result.spacing = distance.value_or(1);
  if (!distance) volume.has_spacing = false;
  return result;
}

/// The name of one of numbered files: `pattern` has one %d, perhaps with a width, such as %03d. Nothing if it has not.
std::optional<std::string> numbered_name(std::string_view pattern, std::int32_t number) {
  const auto percent = pattern.find('%');
  if (percent == std::string_view::npos) return std::nullopt;
  auto rest = pattern.substr(percent + 1);
  const bool has_zeros = rest.starts_with('0');
  if (has_zeros) rest.remove_prefix(1);
  int width = 0;
  if (!rest.empty() && rest.front() >= '1' && rest.front() <= '9') {
    width = rest.front() - '0';
    rest.remove_prefix(1);
  }
  if (!rest.starts_with('d') || rest.find('%') != std::string_view::npos) return std::nullopt;
  const auto digits = has_zeros ? fmt::format("{:0{}}", number, width) : fmt::format("{:{}}", number, width);
  return fmt::format("{}{}{}", pattern.substr(0, percent), digits, rest.substr(1));
}

/// "name%03d.raw 1 93 1" names files by number: first, last, step. Nothing if it is no such pattern.
std::optional<std::vector<std::string>> numbered_files(const std::filesystem::path& file, const std::string& value) {
  std::istringstream stream(value);
  const std::vector<std::string> parts{std::istream_iterator<std::string>(stream), {}};
  if (parts.size() < 4 || !numbered_name(parts[0], 0)) return std::nullopt;
  const auto first = number<std::int32_t>(parts[1]);
  const auto last = number<std::int32_t>(parts[2]);
  const auto step = number<std::int32_t>(parts[3]);
  if (!first || !last || !step) return std::nullopt;

  constexpr std::int64_t most_files = 65536;
  const auto span = std::int64_t{*last} - *first;
  const bool leads_there = *step != 0 && (span == 0 || (span > 0) == (*step > 0));
  if (!leads_there || span / *step >= most_files) {
    refuse(file, fmt::format("the data files are \"{}\"", printable(value)),
           "a step that leads from the first to the last number, and at most 65536 files, are allowed");
  }
  std::vector<std::string> names;
  for (std::int64_t index = 0; index <= span / *step; ++index) {
    names.push_back(numbered_name(parts[0], static_cast<std::int32_t>(*first + index * *step)).value_or(""));
  }
  return names;
}

/// The files that hold the voxels, each with where the stream begins in it: after the header if attached.
std::vector<StoredVolume::Share> data_files(const std::filesystem::path& file, const Header& header) {
  const auto value = header.field(nrrdField_data_file);
  if (!header.fields.contains(nrrdField_data_file)) {
    if (!header.data_begin) {
      refuse(file, "the header ends without an empty line",
             "data after an empty line or a field \"data file\" are needed");
    }
    return {{file, *header.data_begin}};
  }
  std::vector<std::string> names{value};
  if (value.starts_with("SKIPLIST"))
    refuse(file, "the data file is a SKIPLIST", "a name, a pattern or LIST are allowed");
  if (value.starts_with("LIST")) {
    names = header.listed_files;
    if (names.empty()) refuse(file, "the list of data files is empty", "at least one is needed");
  } else if (auto numbered = numbered_files(file, value)) {
    names = std::move(*numbered);
  }
  std::vector<StoredVolume::Share> shares;
  shares.reserve(names.size());
  for (const auto& name : names) shares.push_back({file.parent_path() / name});
  return shares;
}

/// Moves the beginning of `share` past `lines` line ends.
void skip_lines(StoredVolume::Share& share, unsigned lines) {
  ByteStream stream(share.file, share.offset);
  std::vector<unsigned char> chunk(std::size_t{1} << 16U);
  while (lines > 0) {
    const auto got = stream.read(chunk);
    if (got == 0)
      refuse(share.file, fmt::format("the data end {} lines too early", lines), "\"line skip\" passes over them");
    for (std::size_t position = 0; position < got && lines > 0; ++position) {
      ++share.offset;
      if (chunk[position] == '\n') --lines;
    }
  }
}

/// With "byte skip: -1" the data are the last bytes, of what gzip data are inflated to.
std::uint64_t bytes_before_the_last(const StoredVolume::Share& share, std::uint64_t wanted, Encoding encoding) {
  const auto bytes = ByteStream(share.file, share.offset, encoding == Encoding::gzip).count_rest();
  if (bytes < wanted) {
    refuse(share.file, fmt::format("the file has {} bytes of data", bytes),
           fmt::format("the header announces {}", wanted));
  }
  return bytes - wanted;
}

}  // namespace

StoredVolume read_nrrd_header(const std::filesystem::path& file, const VolumeChoices& choices) {
  const Header header = read_lines(file);
  check_fields(file, header);

  StoredVolume stored;
  auto& volume = stored.volume;
  volume.file = file;
  volume.format = "NRRD";
  volume.type = voxel_type(file, header.field(nrrdField_type));
  volume.encoding = encoding(file, header.field(nrrdField_encoding));

  const OwnedNrrd nrrd(nrrdNew(), nrrdNuke);
  const OwnedState state(nrrdIoStateNew(), nrrdIoStateNix);
  parse(file, header, *nrrd, *state);
  volume.endian = state->endian == airEndianBig ? std::endian::big : std::endian::little;
  std::vector<StoredAxis> axes;
  for (unsigned axis = 0; axis < nrrd->dim; ++axis) axes.push_back(stored_axis(*nrrd, axis, volume));
  warn_of_shear(*nrrd, volume);
  if (header.fields.contains(nrrdField_space_directions) && header.fields.contains(nrrdField_axis_mins)) {
    volume.warnings.emplace_back("\"axis mins\" are passed over, for the header has \"space directions\"");
  }
  set_axes(stored, axes, choices);

  stored.shares = data_files(file, header);
  const auto count = stored_count(stored);
  if (count % stored.shares.size() != 0) {
    refuse(file, fmt::format("{} data files hold {} voxels", stored.shares.size(), count),
           "an equal share each is allowed");
  }
  const auto share_bytes = count / stored.shares.size() * static_cast<unsigned>(facts(volume.type).bytes);
  for (auto& share : stored.shares) {
    skip_lines(share, state->lineSkip);
    if (state->byteSkip >= 0) {
      share.skip = static_cast<std::uint64_t>(state->byteSkip);
    } else if (state->byteSkip == -1 && volume.encoding != Encoding::ascii) {
      share.skip = bytes_before_the_last(share, share_bytes, volume.encoding);
    } else {
      refuse(file, fmt::format("\"byte skip\" is {}", state->byteSkip),
             "0 and more, and -1 for raw and gzip data, are allowed");
    }
  }
  return stored;
}

}  // namespace raytruth
