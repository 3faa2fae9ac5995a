#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/transfer_files/transfer_file.hpp"
#include "raytruth/transfer/color_map.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

/// What a file's opacities are those of.
enum class OpacityUnit { world, side_200, side_150 };

/// What a file says of its scalars: they are the data's own; they are stretched over the data; or nothing.
enum class FileScalars { absolute, relative, unstated };

/// A transfer function of a file, before anything is known of the volume.
struct FileMap {
  std::string format;
  std::string name = {};
  ColorMap map = {};
  OpacityUnit unit = OpacityUnit::world;
  double unit_distance = 1;  ///< world units, where `unit` is these
  FileScalars scalars = FileScalars::absolute;
  std::optional<std::array<double, 2>> own_range = {};  ///< that is stretched; none: from the first point to the last
  bool has_gradient_opacity = false;
  nlohmann::ordered_json lighting = {};   ///< that the file asks for; null: none
  std::vector<std::string> ignored = {};  ///< what else it says that changes nothing here
};

/// A transfer function that a file holds, under its name.
struct NamedMap {
  std::string name;
  std::function<FileMap()> read;
};

// The readers: all maps of a file. Each throws InputError with the file and the place in it, here or when a map is
// read.

std::vector<NamedMap> read_json_maps(const std::filesystem::path& file);    ///< .json, by what is in it
std::vector<NamedMap> read_xml_maps(const std::filesystem::path& file);     ///< .xml, by what is in it
std::vector<NamedMap> read_slicer_xml(const std::filesystem::path& file);   ///< .mrml
std::vector<NamedMap> read_slicer_text(const std::filesystem::path& file);  ///< .vp
std::vector<NamedMap> read_slicer_json(const JsonReader& document);         ///< .vp.json
std::vector<NamedMap> read_vtk_json(const JsonReader& document);            ///< ParaView, VolView, ParaView Glance
std::vector<NamedMap> read_vtk_xml(const std::filesystem::path& file);      ///< ParaView
std::vector<NamedMap> read_voreen(const std::filesystem::path& file);       ///< .tfi
std::vector<NamedMap> read_inviwo(const std::filesystem::path& file);       ///< .itf

// --- What they share ---

[[noreturn]] inline void refuse(std::string_view place, std::string_view found, std::string_view allowed) {
  throw InputError(one_line(fmt::format("{}: found {}; {} is allowed", place, found, allowed)));
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
