#include "raytruth/volume/files/describe_volume.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <vector>

namespace raytruth {
namespace {

std::string_view endian(const Volume& volume) {
  if (facts(volume.type).bytes == 1 || volume.encoding == Encoding::ascii) return "none";
  return volume.endian == std::endian::little ? "little" : "big";
}

std::uint64_t count_levels(const Volume& volume) {
  const auto& values = volume.grid.values;
  if (facts(volume.type).bytes > 2) {
    auto sorted = values;
    tbb::parallel_sort(sorted.begin(), sorted.end());
    return static_cast<std::uint64_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
  }
  // There are at most 65536 levels, and most are repeated by the next voxel.
  std::unordered_set<double> levels{values.front()};
  double previous = values.front();
  for (const double value : values) {
    if (value != previous) levels.insert(value);
    previous = value;
  }
  return levels.size();
}

bool is_constant(const Grid& grid, std::size_t axis, std::int64_t layer) {
  std::array<std::int64_t, 3> from{};
  auto to = grid.size;
  from[axis] = layer;
  to[axis] = layer + 1;
  const double value = grid.at(from[0], from[1], from[2]);
  for (auto k = from[2]; k < to[2]; ++k) {
    for (auto j = from[1]; j < to[1]; ++j) {
      for (auto i = from[0]; i < to[0]; ++i) {
        if (grid.at(i, j, k) != value) return false;
      }
    }
  }
  return true;
}

std::array<std::int64_t, 2> constant_layers(const Grid& grid, std::size_t axis) {
  const auto count = grid.size[axis];
  std::int64_t low = 0;
  while (low < count && is_constant(grid, axis, low)) ++low;
  std::int64_t high = 0;
  while (high < count && is_constant(grid, axis, count - 1 - high)) ++high;
  return {low, high};
}

}  // namespace

VolumeDescription describe_volume(const Volume& volume) {
  const auto& values = volume.grid.values;
  const auto type = facts(volume.type);
  const auto [minimum, maximum] = volume.grid.range();
  const auto share = [&](double value) {
    return static_cast<double>(std::count(values.begin(), values.end(), value)) / static_cast<double>(values.size());
  };

  VolumeDescription description;
  description.file = volume.file.string();
  description.format = volume.format;
  description.type = type.name;
  description.encoding = name(volume.encoding);
  description.endian = endian(volume);
  description.bytes_per_voxel = type.bytes;
  description.is_integer = type.is_integer;
  description.is_signed = type.is_signed;
  description.slope = volume.slope;
  description.intercept = volume.intercept;
  description.size = volume.grid.size;
  description.spacing = volume.grid.spacing;
  description.has_spacing = volume.has_spacing;
  description.minimum = minimum;
  description.maximum = maximum;
  description.levels = count_levels(volume);
  if (type.is_integer) description.possible_levels = std::round((maximum - minimum) / std::abs(volume.slope)) + 1;
  description.share_at_minimum = share(minimum);
  description.share_of_zeros = share(0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    description.constant_layers[axis] = constant_layers(volume.grid, axis);
  }
  description.lost_first_byte = volume.lost_first_byte;
  description.warnings = volume.warnings;
  return description;
}

}  // namespace raytruth
