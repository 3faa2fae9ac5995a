#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/transfer_files/transfer_file.hpp"
#include "raytruth/transfer/color_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// What a file's opacities are those of.
enum class OpacityUnit { spacing, side_200, side_150 };

/// A transfer function of a file, before anything is known of the grid.
struct FileMap {
  std::string format;
  std::string name = {};
  ColorMap map = {};
  OpacityUnit unit = OpacityUnit::spacing;
  std::optional<std::array<double, 2>> own_range =
      {};  ///< of scalars that stands for the data's; none: they are the data's
  bool has_gradient_opacity = false;
};

/// How the files of a program are read: a row of `transfer_file_formats()`.
struct TransferFileFormat {
  std::string_view extension;
  FileMap (*read)(const TransferFileRequest&);
};

/// Every format, by its extension (transfer_file.cpp names them).
std::span<const TransferFileFormat> transfer_file_formats();

// The readers. Each throws InputError with the file and the place in it.

FileMap read_vtk_preset(const TransferFileRequest& request);      ///< JSON of ParaView, VolView, ParaView Glance
FileMap read_slicer_text(const TransferFileRequest& request);     ///< 3D Slicer's .vp
FileMap read_slicer_presets(const TransferFileRequest& request);  ///< 3D Slicer's .xml and .mrml
FileMap read_voreen(const TransferFileRequest& request);          ///< .tfi
FileMap read_inviwo(const TransferFileRequest& request);          ///< .itf

// --- What they share ---

[[noreturn]] inline void refuse(std::string_view place, std::string_view found, std::string_view allowed) {
  throw InputError(one_line(fmt::format("{}: found {}; {} is allowed", place, found, allowed)));
}

/// Takes the one of this name; of a single one, none need be named.
template <class Map, class NameOf>
const Map& chosen(const std::vector<Map>& maps, const TransferFileRequest& request, const NameOf& name_of) {
  const std::string file = request.file.string();
  if (maps.empty()) refuse(file, "no transfer function", "one or more");
  std::vector<std::string> names;
  for (const Map& map : maps) names.push_back(name_of(map));
  if (!request.preset) {
    if (maps.size() == 1) return maps.front();
    refuse(file, fmt::format("{} transfer functions and no preset named", maps.size()),
           fmt::format("\"preset\" with one of their names ({}, ...)", shortened(names.front())));
  }
  const auto found = std::find(names.begin(), names.end(), *request.preset);
  if (found == names.end()) {
    const auto closest = closest_word(*request.preset, std::vector<std::string_view>(names.begin(), names.end()));
    refuse(file,
           fmt::format("no preset {}{}", shortened(*request.preset),
                       closest.empty() ? "" : fmt::format(" (perhaps {})", closest)),
           fmt::format("one of {}", shortened(fmt::format("{}", fmt::join(names, ", ")), 200)));
  }
  return maps[static_cast<std::size_t>(found - names.begin())];
}

/// Numbers in groups: the first of each group is the scalar.
template <std::size_t Size>
std::vector<std::array<double, Size>> groups_of(const std::string& place, const std::vector<double>& numbers) {
  if (numbers.empty() || numbers.size() % Size != 0)
    refuse(place, fmt::format("{} numbers", numbers.size()), fmt::format("a multiple of {}", Size));
  std::vector<std::array<double, Size>> groups(numbers.size() / Size);
  for (std::size_t i = 0; i < numbers.size(); ++i) groups[i / Size][i % Size] = numbers[i];
  return groups;
}

inline void add_colors(ColorMap& map, const std::string& place, const std::vector<double>& numbers) {
  for (const auto& [s, r, g, b] : groups_of<4>(place, numbers)) map.colors.push_back({s, {r, g, b}});
}

inline void add_opacities(ColorMap& map, const std::string& place, const std::vector<double>& numbers) {
  for (const auto& [s, opacity] : groups_of<2>(place, numbers)) map.opacities.push_back({s, opacity});
}

}  // namespace raytruth
