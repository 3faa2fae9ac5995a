#include "raytruth/documents/transfer_files/transfer_file.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/transfer_files/file_map.hpp"
#include "raytruth/transfer/color_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

FileMap read_map(const TransferFileRequest& request) {
  const std::string extension = request.file.extension().string();
  std::vector<std::string_view> known;
  for (const TransferFileFormat& format : transfer_file_formats()) {
    if (format.extension == extension) return format.read(request);
    known.push_back(format.extension);
  }
  refuse(request.file.string(), fmt::format("the extension \"{}\"", shortened(extension)),
         fmt::format("one of {}", fmt::join(known, ", ")));
}

/// The length that opacities are those of, in smallest spacings.
double length_of(OpacityUnit unit, const Grid& grid) {
  if (unit == OpacityUnit::spacing) return 1;
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    side = std::max(side, static_cast<double>(grid.size[axis]) * grid.spacing[axis]);
  const double smallest = *std::min_element(grid.spacing.begin(), grid.spacing.end());
  return side / smallest / (unit == OpacityUnit::side_200 ? 200 : 150);
}

std::string_view words_of(OpacityUnit unit) {
  switch (unit) {
    case OpacityUnit::side_200:
      return "of 1/200 of the grid's longest side, as Voreen's reference step";
    case OpacityUnit::side_150:
      return "of 1/150 of the grid's longest side, as Inviwo's reference step";
    default:
      return "of a smallest spacing, as VTK's unit distance of 1";
  }
}

/// Stretches the scalars of a map from its own range to another one.
void stretch(FileMap& map, const std::array<double, 2>& to, const std::string& file) {
  const auto from = map.own_range.value_or(std::array{map.map.colors.front().s, map.map.colors.back().s});
  if (!(from[0] < from[1]))
    refuse(file, fmt::format("scalars from {} to {}", from[0], from[1]), "a range that can be stretched");
  const auto moved = [&](double s) { return to[0] + (s - from[0]) / (from[1] - from[0]) * (to[1] - to[0]); };
  for (auto& key : map.map.colors) key.s = moved(key.s);
  for (auto& key : map.map.opacities) key.s = moved(key.s);
}

}  // namespace

std::span<const TransferFileFormat> transfer_file_formats() {
  static constexpr std::array formats{
      TransferFileFormat{".json", read_vtk_preset},     TransferFileFormat{".xml", read_slicer_presets},
      TransferFileFormat{".mrml", read_slicer_presets}, TransferFileFormat{".vp", read_slicer_text},
      TransferFileFormat{".tfi", read_voreen},          TransferFileFormat{".itf", read_inviwo},
  };
  return formats;
}

FileTransfer read_transfer_file(const TransferFileRequest& request, const Grid& grid,
                                std::vector<std::string>& /*warnings*/) {
  const std::string file = request.file.string();
  FileMap map = read_map(request);
  if (map.map.colors.empty()) refuse(file, "no colours", "one or more");
  if (map.has_gradient_opacity && !request.ignores_gradient_opacity)
    refuse(file, "opacity that depends on the gradient", "it, with --ignore-gradient-opacity,");
  if (request.opacity) {
    FileMap other = read_map({.file = *request.opacity, .ignores_gradient_opacity = request.ignores_gradient_opacity});
    if (other.has_gradient_opacity && !request.ignores_gradient_opacity)
      refuse(request.opacity->string(), "opacity that depends on the gradient", "it, with --ignore-gradient-opacity,");
    map.map.opacities = std::move(other.map.opacities);
    map.unit = other.unit;
  }
  if (map.map.opacities.empty())
    refuse(file, "a map of colours without opacity", "such a map together with --opacity FILE");

  std::string scalars = "those of the file are the data's";
  if (request.range || map.own_range) {
    const auto [low, high] = grid.range();
    const auto to = request.range.value_or(std::array{low, high});
    stretch(map, to, file);
    scalars = fmt::format("those of the file stretched from {} to {}", to[0], to[1]);
  }
  const double unit_length = request.unit_length.value_or(length_of(map.unit, grid));
  Json description{{"file", request.file.filename().string()}, {"format", map.format}};
  if (!map.name.empty()) description["preset"] = map.name;
  description["color"] = "the file's RGB, taken as linear light";
  description["opacity"] = request.unit_length ? "of unit_length, as asked for" : words_of(map.unit);
  description["unit_length"] = unit_length;
  description["scalars"] = scalars;
  if (map.has_gradient_opacity) description["gradient_opacity"] = "ignored";
  try {
    return {transfer_of(map.map, unit_length), std::move(description)};
  } catch (const InputError& error) {
    throw InputError(one_line(fmt::format("{}: {}", file, error.what())));
  }
}

}  // namespace raytruth
