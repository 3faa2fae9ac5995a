#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "raytruth/volume/files/read_volume.hpp"

namespace raytruth {

/// What there is to know about a volume before one trusts it.
struct VolumeDescription {
  std::string file;
  std::string_view format;
  std::string_view type;
  std::string_view encoding;
  std::string_view endian;  // "little", "big"; "none" where the bytes have no order
  int bytes_per_voxel = 0;
  bool is_integer = false;
  bool is_signed = false;
  double slope = 1;
  double intercept = 0;
  std::array<std::int64_t, 3> size{};
  std::array<double, 3> spacing{};
  bool has_spacing = true;  // the file, or whoever asked for it, states the spacing
  double minimum = 0;
  double maximum = 0;
  std::uint64_t levels = 0;               // different values in use
  std::optional<double> possible_levels;  // of how many between minimum and maximum; integer types only
  double share_at_minimum = 0;
  double share_of_zeros = 0;
  /// How many whole layers, from each face inwards, hold one value only: [axis][0 low face, 1 high face].
  std::array<std::array<std::int64_t, 2>, 3> constant_layers{};
  bool lost_first_byte = false;
  std::vector<std::string> warnings;  // of the reader
};

/// Describes `volume`, which has at least one voxel.
[[nodiscard]] VolumeDescription describe_volume(const Volume& volume);

}  // namespace raytruth
