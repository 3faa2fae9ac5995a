#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "raytruth/volume/files/byte_stream.hpp"
#include "raytruth/volume/files/refuse.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

// Teem and libnifti read the headers; the voxels are read here, for both alike. Teem 1.12 does not look at the checksum
// of gzip data, lets ASCII numbers overflow its buffer and their type, and loses memory when data end early; libnifti
// asks for the announced memory before it looks at the file and fills what is missing with zeros.

namespace raytruth {
namespace {

constexpr std::size_t chunk_voxels = std::size_t{1} << 16U;

/// Takes the stored numbers one by one, in the file's order, and keeps those of the volume that is asked for.
class Values {
 public:
  Values(StoredVolume& stored, const VolumeChoices& choices)
      : volume_(stored.volume),
        series_(stored.series),
        is_z_fastest_(stored.is_z_fastest),
        nan_(choices.nan),
        values_(volume_.grid.values.data()) {}

  template <class T>
  void add(T stored) {
    if (!is_kept()) {
      ++passed_;
      return;
    }
    if constexpr (std::is_integral_v<T> && sizeof(T) == sizeof(std::int64_t)) note_rounding(stored);
    double value = volume_.slope * static_cast<double>(stored) + volume_.intercept;
    if (!std::isfinite(value)) value = note_not_finite(value);
    values_[place()] = value;
    ++passed_;
    ++kept_;
  }

  /// "voxel (i, j, k)", the next one.
  [[nodiscard]] std::string name_of_place() const { return name_of(place()); }

  /// Once all are there: refuses voxels that are not finite, and warns of what became of others.
  void finish() {
    const auto all = voxel_count(volume_);
    if (infinite_.count > 0) {
      refuse(
          volume_.file,
          fmt::format("{} of {} voxels are infinite, the first is {}", infinite_.count, all, name_of(infinite_.first)),
          "only finite values are allowed; numpy.nan_to_num makes them so");
    }
    if (not_numbers_.count > 0) {
      const auto found =
          fmt::format("{} of {} voxels are NaN, the first is {}", not_numbers_.count, all, name_of(not_numbers_.first));
      if (!nan_) {
        refuse(volume_.file, found,
               "only finite values are allowed; --nan VALUE, or \"nan\": VALUE beside \"volume\", gives them one");
      }
      volume_.warnings.push_back(fmt::format("{}; they are given the value {}", found, *nan_));
    }
    if (rounded_ > 0) {
      volume_.warnings.push_back(
          fmt::format("{} of {} voxels are integers beyond 2^53, which binary64 does not keep apart: {} of them are "
                      "rounded, and different ones may have become the same",
                      beyond_, all, rounded_));
    }
  }

 private:
  /// Voxels of a kind: how many, and which is the first.
  struct Tally {
    std::uint64_t count = 0;
    std::uint64_t first = 0;

    void add(std::uint64_t place) {
      if (count++ == 0) first = place;
    }
  };

  [[nodiscard]] bool is_kept() const {
    return series_.count == 1 || passed_ / series_.together % series_.count == series_.step;
  }

  /// Where the next voxel stands in the grid, x fastest.
  [[nodiscard]] std::uint64_t place() const {
    if (!is_z_fastest_) return kept_;
    const auto nx = static_cast<std::uint64_t>(volume_.grid.size[0]);
    const auto ny = static_cast<std::uint64_t>(volume_.grid.size[1]);
    const auto nz = static_cast<std::uint64_t>(volume_.grid.size[2]);
    return kept_ / nz / ny + nx * (kept_ / nz % ny + ny * (kept_ % nz));
  }

  [[nodiscard]] std::string name_of(std::uint64_t place) const {
    const auto [nx, ny, nz] = volume_.grid.size;
    const auto index = static_cast<std::int64_t>(place);
    return fmt::format("voxel ({}, {}, {})", index % nx, index / nx % ny, index / nx / ny);
  }

  /// Returns what the voxel becomes. All of them are counted before any is refused.
  double note_not_finite(double value) {
    if (!std::isnan(value)) {
      infinite_.add(place());
      return value;
    }
    not_numbers_.add(place());
    return nan_.value_or(value);
  }

  /// Binary64 holds an integer if its digits, from the first 1 to the last, are at most 53.
  template <class T>
  void note_rounding(T stored) {
    constexpr int digits = std::numeric_limits<double>::digits;
    const auto bits = static_cast<std::uint64_t>(stored);
    const std::uint64_t magnitude = stored < 0 ? 0 - bits : bits;
    const auto width = static_cast<int>(std::bit_width(magnitude));
    if (width <= digits) return;
    ++beyond_;
    if (width - std::countr_zero(magnitude) > digits) ++rounded_;
  }

  Volume& volume_;
  StoredVolume::Series series_;
  bool is_z_fastest_;
  std::optional<double> nan_;
  double* values_;
  std::uint64_t passed_ = 0;  // numbers of the file, of whichever volume
  std::uint64_t kept_ = 0;    // of these, those that were of the volume
  Tally not_numbers_;
  Tally infinite_;
  std::uint64_t beyond_ = 0;  // 2^53
  std::uint64_t rounded_ = 0;
};

template <class T>
T from_bytes(const unsigned char* bytes, std::endian endian) {
  std::array<unsigned char, sizeof(T)> ordered{};
  std::memcpy(ordered.data(), bytes, sizeof(T));
  if (endian != std::endian::native) std::reverse(ordered.begin(), ordered.end());
  return std::bit_cast<T>(ordered);
}

template <class T>
void add_binary(ByteStream& stream, std::uint64_t count, const StoredVolume::Share& share, Volume& volume,
                Values& values) {
  std::vector<unsigned char> chunk(chunk_voxels * sizeof(T));
  for (std::uint64_t done = 0; done < count;) {
    const auto wanted = std::min<std::uint64_t>(count - done, chunk_voxels);
    const auto got = stream.read(std::span(chunk).first(wanted * sizeof(T)));
    if (got < wanted * sizeof(T)) {
      refuse(share.file, fmt::format("the data end after {} bytes", done * sizeof(T) + got),
             fmt::format("the header announces {}", count * sizeof(T)));
    }
    for (std::size_t voxel = 0; voxel < wanted; ++voxel) {
      values.add(from_bytes<T>(&chunk[voxel * sizeof(T)], volume.endian));
    }
    volume.lost_first_byte = sizeof(T) == 1 && chunk[wanted - 1] == '\n';
    done += wanted;
  }
  if (const auto more = stream.count_rest(); more > 0) {
    volume.warnings.push_back(fmt::format(
        "the header announces {} bytes of data; the {} bytes behind them are not read", count * sizeof(T), more));
  }
}

/// Numbers that white space or commas separate.
class Words {
 public:
  explicit Words(ByteStream& stream) : stream_(stream), buffer_(std::size_t{1} << 16U) {}

  /// More characters of a word are not kept: no number needs them.
  static constexpr std::size_t longest = 1000;

  /// The next word; empty at the end.
  std::string_view next() {
    word_.clear();
    for (;;) {
      if (position_ == filled_) {
        filled_ = stream_.read(buffer_);
        position_ = 0;
        if (filled_ == 0) return word_;
      }
      const char character = static_cast<char>(buffer_[position_++]);
      if (std::string_view(" \t\r\n\f\v,").find(character) != std::string_view::npos) {
        if (!word_.empty()) return word_;
      } else if (word_.size() < longest) {
        word_.push_back(character);
      }
    }
  }

 private:
  ByteStream& stream_;
  std::vector<unsigned char> buffer_;
  std::size_t position_ = 0;
  std::size_t filled_ = 0;
  std::string word_;
};

template <class T>
void add_ascii(ByteStream& stream, std::uint64_t count, const StoredVolume::Share& share, Volume& volume,
               Values& values) {
  Words words(stream);
  for (std::uint64_t done = 0; done < count; ++done) {
    const auto word = words.next();
    if (word.empty()) {
      refuse(share.file, fmt::format("the data end after {} numbers", done),
             fmt::format("the header announces {}", count));
    }
    const auto digits = word.front() == '+' ? word.substr(1) : word;
    T number{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size() || word.size() == Words::longest) {
      refuse(share.file, fmt::format("{} is \"{}\"", values.name_of_place(), printable(word)),
             fmt::format("a number of type {} is allowed", facts(volume.type).name));
    }
    values.add(number);
  }
  std::uint64_t more = 0;
  while (!words.next().empty()) ++more;
  if (more > 0) {
    volume.warnings.push_back(
        fmt::format("the header announces {} numbers; the {} words behind them are not read", count, more));
  }
}

template <class T>
void add_share(const StoredVolume::Share& share, std::uint64_t count, Volume& volume, Values& values) {
  ByteStream stream(share.file, share.offset, volume.encoding == Encoding::gzip);
  stream.skip(share.skip);
  if (volume.encoding == Encoding::ascii) {
    add_ascii<T>(stream, count, share, volume, values);
  } else {
    add_binary<T>(stream, count, share, volume, values);
  }
  if (stream.ignored_bytes() > 0) {
    volume.warnings.push_back(
        fmt::format("the {} bytes behind the gzip data are no such data, and are not read", stream.ignored_bytes()));
  }
}

auto adder(VoxelType type) {
  switch (type) {
    case VoxelType::int8:
      return add_share<std::int8_t>;
    case VoxelType::uint8:
      return add_share<std::uint8_t>;
    case VoxelType::int16:
      return add_share<std::int16_t>;
    case VoxelType::uint16:
      return add_share<std::uint16_t>;
    case VoxelType::int32:
      return add_share<std::int32_t>;
    case VoxelType::uint32:
      return add_share<std::uint32_t>;
    case VoxelType::int64:
      return add_share<std::int64_t>;
    case VoxelType::uint64:
      return add_share<std::uint64_t>;
    case VoxelType::float32:
      return add_share<float>;
    default:
      return add_share<double>;
  }
}

/// Refuses a file that is too small for its share of the voxels, whatever it holds.
void check_capacity(const StoredVolume::Share& share, std::uint64_t count, Volume& volume) {
  const bool ascii = volume.encoding == Encoding::ascii;
  const ByteStream stream(share.file, share.offset, volume.encoding == Encoding::gzip);
  const auto most = stream.most_bytes();
  // In ASCII every voxel takes a digit, and something stands between two of them.
  const auto least = ascii ? 2 * count - 1 : count * static_cast<std::uint64_t>(facts(volume.type).bytes);
  if (share.skip > most || least > most - share.skip) {
    refuse(share.file,
           fmt::format("the file can hold no more than {} bytes of data", most - std::min(most, share.skip)),
           fmt::format("the header announces {} voxels, {} bytes", count, least));
  }
  if (volume.encoding != Encoding::gzip || stream.is_gzip()) return;
  // Bytes of another number might be gzip data whose first ones are damaged.
  if (least != most - share.skip) {
    refuse(share.file, fmt::format("the data are not gzip, and {} bytes", most - share.skip),
           fmt::format("gzip data, or the {} bytes that the header announces, are allowed", least));
  }
  volume.warnings.emplace_back("the data are not gzip, as the name or the header says; they are read as they are");
}

void check_memory(const StoredVolume& stored, std::uint64_t limit) {
  const auto bytes = voxel_count(stored.volume) * sizeof(double);
  if (bytes <= limit) return;
  const auto [nx, ny, nz] = stored.volume.grid.size;
  refuse(
      stored.volume.file,
      fmt::format("the header announces {} x {} x {} voxels of type {}, which need {} bytes of memory", nx, ny, nz,
                  facts(stored.volume.type).name, bytes),
      fmt::format("the memory limit is {} bytes; --memory-limit SIZE, or RAYTRUTH_MEMORY_LIMIT, sets another", limit));
}

/// The series that the axes make; its axis is taken from those that are kept.
StoredVolume::Series series_of(const std::filesystem::path& file, std::span<const StoredAxis> axes,
                               std::vector<std::size_t>& kept, const VolumeChoices& choices) {
  StoredVolume::Series series;
  const auto is_series = [&axes](std::size_t axis) {
    return axes[axis].kind == StoredAxis::Kind::time && axes[axis].size > 1;
  };
  const auto found = std::find_if(kept.begin(), kept.end(), is_series);
  if (found != kept.end()) {
    const auto& time = axes[*found];
    if (!choices.time_step) {
      refuse(
          file, time.what,
          fmt::format("one volume is allowed: --time-step N, or \"time_step\": N beside \"volume\", reads one of the "
                      "{}, from 0",
                      time.size));
    }
    series.count = time.size;
    for (std::size_t faster = 0; faster < *found; ++faster) series.together *= axes[faster].size;
    kept.erase(found);
  }
  const auto step = choices.time_step.value_or(0);
  if (step < 0 || static_cast<std::uint64_t>(step) >= series.count) {
    refuse(file, fmt::format("the time step {} is asked for", step),
           series.count == 1 ? "the file holds one volume: 0 is allowed"
                             : fmt::format("0 to {} are allowed", series.count - 1));
  }
  series.step = static_cast<std::uint64_t>(step);
  return series;
}

/// The distance of neighbours along an axis, made positive.
double positive_spacing(Volume& volume, std::size_t axis, double spacing) {
  if (spacing == 0 || !std::isfinite(spacing)) {
    refuse(volume.file, fmt::format("the spacing of axis {} is {}", axis, spacing),
           "a finite number is allowed that is not 0; --spacing X Y Z, or \"spacing\": [x, y, z] beside \"volume\", "
           "states another");
  }
  if (spacing < 0) {
    volume.warnings.push_back(
        fmt::format("the spacing of axis {} is {}, for it runs backwards; {} is taken, in the file's order of voxels",
                    axis, spacing, -spacing));
  }
  return std::abs(spacing);
}

}  // namespace

void check_sizes(const std::filesystem::path& file, std::span<const std::uint64_t> sizes, std::string_view shape) {
  auto most = static_cast<std::uint64_t>(most_voxels);
  for (const auto size : sizes) {
    if (size < 1 || size > most) {
      refuse(file, fmt::format("the sizes are {}", shape), "sizes >= 1 and at most 2^33 voxels are allowed");
    }
    most /= size;
  }
}

void set_axes(StoredVolume& stored, std::span<const StoredAxis> axes, const VolumeChoices& choices) {
  auto& volume = stored.volume;
  std::vector<std::uint64_t> sizes;
  for (const auto& axis : axes) sizes.push_back(axis.size);
  const auto shape = fmt::format("{}", fmt::join(sizes, " x "));
  check_sizes(volume.file, sizes, shape);

  std::vector<std::size_t> kept(axes.size());
  std::iota(kept.begin(), kept.end(), 0);
  stored.series = series_of(volume.file, axes, kept, choices);
  for (const bool is_of_space : {false, true}) {
    for (std::size_t axis = axes.size(); axis-- > 0 && kept.size() > 3;) {
      if (sizes[axis] == 1 && (axes[axis].kind == StoredAxis::Kind::space) == is_of_space) std::erase(kept, axis);
    }
  }
  for (const auto axis : kept) {
    if (axes[axis].kind != StoredAxis::Kind::space && axes[axis].size > 1) {
      refuse(volume.file, axes[axis].what,
             fmt::format("three axes of space are allowed, each of one number a voxel; {}", npy_is_the_way_in));
    }
  }
  if (kept.size() != 3) {
    refuse(volume.file, "the sizes are " + shape, "three axes are allowed, and further ones of size 1");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& [size, spacing, kind, what] = axes[kept[axis]];
    volume.grid.size[axis] = static_cast<std::int64_t>(size);
    volume.grid.spacing[axis] = choices.spacing ? std::abs(spacing) : positive_spacing(volume, kept[axis], spacing);
  }
  if (!choices.spacing) return;
  if (volume.has_spacing && volume.grid.spacing != *choices.spacing) {
    volume.warnings.push_back(fmt::format("the file states the spacing {}; {}, which is asked for, is taken",
                                          fmt::join(volume.grid.spacing, " "), fmt::join(*choices.spacing, " ")));
  }
  volume.grid.spacing = *choices.spacing;
  volume.has_spacing = true;
}

std::optional<std::string> shear_warning(const std::vector<std::vector<double>>& directions, std::string_view what) {
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  constexpr double tolerance = 1e-3;
  double largest = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double lengths =
          std::sqrt(product(directions[i], directions[i])) * std::sqrt(product(directions[j], directions[j]));
      if (lengths > 0) largest = std::max(largest, std::abs(product(directions[i], directions[j])) / lengths);
    }
  }
  if (!(largest > tolerance)) return std::nullopt;
  const double degrees = std::acos(std::min(largest, 1.0)) * 180 / std::numbers::pi;
  return fmt::format("{} are sheared, two of them meet at {:.1f} degrees; a grid of right angles is taken", what,
                     degrees);
}

std::uint64_t voxel_count(const Volume& volume) {
  const auto& size = volume.grid.size;
  return static_cast<std::uint64_t>(size[0] * size[1] * size[2]);
}

std::uint64_t stored_count(const StoredVolume& stored) { return voxel_count(stored.volume) * stored.series.count; }

Volume read_voxels(StoredVolume stored, const VolumeChoices& choices, std::uint64_t memory_limit) {
  auto& volume = stored.volume;
  const auto count = stored_count(stored) / stored.shares.size();
  for (const auto& share : stored.shares) check_capacity(share, count, volume);
  check_memory(stored, memory_limit);
  try {
    volume.grid.values.resize(voxel_count(volume));
  } catch (const std::bad_alloc&) {
    refuse(volume.file,
           fmt::format("its {} voxels need {} MiB of memory", voxel_count(volume), voxel_count(volume) >> 17U),
           "what this machine has is allowed");
  }
  Values values(stored, choices);
  for (const auto& share : stored.shares) adder(volume.type)(share, count, volume, values);
  values.finish();
  // The last byte of the file is not the last voxel's then.
  if (stored.series.count > 1 || stored.is_z_fastest) volume.lost_first_byte = false;
  return std::move(volume);
}

std::uint64_t memory_of_machine() {
  const auto pages = ::sysconf(_SC_PHYS_PAGES);
  const auto bytes_per_page = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || bytes_per_page <= 0) return std::numeric_limits<std::uint64_t>::max();
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(bytes_per_page);
}

}  // namespace raytruth
