#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/mesh_files/mesh_file.hpp"
#include "raytruth/documents/volume_source.hpp"
#include "raytruth/volume/files/describe_volume.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

namespace raytruth {

namespace {

struct InfoOptions {
  std::string volume;
  bool json = false;
  VolumeOptions volumes;
  std::optional<std::int64_t> time_step;
  std::vector<double> spacing;  ///< empty: the file's
};

using Json = nlohmann::ordered_json;

Json description_json(const VolumeDescription& volume) {
  Json json{{"file", volume.file},
            {"format", volume.format},
            {"type", volume.type},
            {"encoding", volume.encoding},
            {"endian", volume.endian},
            {"bytes_per_voxel", volume.bytes_per_voxel},
            {"slope", volume.slope},
            {"intercept", volume.intercept},
            {"size", volume.size},
            {"spacing", volume.spacing},
            {"has_spacing", volume.has_spacing},
            {"minimum", volume.minimum},
            {"maximum", volume.maximum},
            {"levels", volume.levels},
            {"possible_levels", nullptr},
            {"share_at_minimum", volume.share_at_minimum},
            {"share_of_zeros", volume.share_of_zeros},
            {"constant_layers", volume.constant_layers},
            {"lost_first_byte", volume.lost_first_byte},
            {"warnings", volume.warnings}};
  if (volume.possible_levels) json["possible_levels"] = *volume.possible_levels;
  return json;
}

std::string description_text(const VolumeDescription& volume) {
  const std::string possible =
      volume.possible_levels ? fmt::format(" of {} between minimum and maximum", *volume.possible_levels) : "";
  const auto& layers = volume.constant_layers;
  std::string text;
  const auto line = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("{:<16}  {}\n", name, value);
  };
  line("file", volume.file);
  line("format", fmt::format("{}, {}, {}{}", volume.format, volume.type, volume.encoding,
                             volume.endian == "none" ? "" : fmt::format(", {} endian", volume.endian)));
  line("size", fmt::format("{}", fmt::join(volume.size, " ")));
  line("spacing",
       fmt::format("{}{}", fmt::join(volume.spacing, " "), volume.has_spacing ? "" : " (the file states none)"));
  if (volume.slope != 1 || volume.intercept != 0)
    line("physical value", fmt::format("{} * stored + {}", volume.slope, volume.intercept));
  line("range", fmt::format("{} .. {}", volume.minimum, volume.maximum));
  line("levels in use", fmt::format("{}{}", volume.levels, possible));
  line("at minimum", fmt::format("{:.2f} % of the voxels", 100 * volume.share_at_minimum));
  line("zeros", fmt::format("{:.2f} % of the voxels", 100 * volume.share_of_zeros));
  line("constant layers", fmt::format("x {} + {}, y {} + {}, z {} + {} (low face + high face)", layers[0][0],
                                      layers[0][1], layers[1][0], layers[1][1], layers[2][0], layers[2][1]));
  line("lost first byte", volume.lost_first_byte ? "likely: the last byte is 0x0A" : "no sign of it");
  return text;
}

/// The least and the greatest of its scalars.
std::pair<double, double> range_of(const TetrahedralMesh& mesh) {
  const auto& scalars = mesh.scalars.empty() ? mesh.cell_scalars : mesh.scalars;
  const auto [low, high] = std::minmax_element(scalars.begin(), scalars.end());
  return {*low, *high};
}

Json mesh_json(const MeshFile& file, const std::string& name) {
  const auto [low, high] = range_of(file.mesh);
  Json json{{"file", name}, {"format", file.format}, {"points", file.mesh.points.size()}};
  json["cells"] = file.mesh.tetrahedra.size();
  json["array"] = file.array;
  json["scalars_of"] = file.is_of_cells ? "cells" : "points";
  json["arrays"] = file.arrays;
  json["minimum"] = low;
  json["maximum"] = high;
  json["warnings"] = file.warnings;
  return json;
}

std::string mesh_text(const MeshFile& file, const std::string& name) {
  const auto [low, high] = range_of(file.mesh);
  std::string text;
  const auto line = [&text](std::string_view what, const std::string& value) {
    text += fmt::format("{:<16}  {}\n", what, value);
  };
  line("file", name);
  line("format", file.format + ", ASCII");
  line("cells", fmt::format("{} tetrahedra", file.mesh.tetrahedra.size()));
  line("points", fmt::format("{}", file.mesh.points.size()));
  line("scalars", one_line(fmt::format("{}, {}", file.array,
                                       file.is_of_cells ? "constant in each cell" : "of points, linear in each cell")));
  line("arrays", one_line(fmt::format("{}", fmt::join(file.arrays, ", "))));
  line("range", fmt::format("{} .. {}", low, high));
  return text;
}

int show_mesh(const InfoOptions& options, const std::filesystem::path& path) {
  if (options.time_step) throw InputError("--time-step: found it with a mesh; one with a series of volumes is allowed");
  if (!options.spacing.empty()) throw InputError("--spacing: found it with a mesh; one with voxels is allowed");
  const MeshFile file = read_mesh(path);
  for (const std::string& warning : file.warnings) say(fmt::format("warning: {}: {}", path.string(), warning));
  print(options.json ? mesh_json(file, path.string()).dump(2) + "\n" : mesh_text(file, path.string()));
  return 0;
}

int show_volume(const InfoOptions& options) {
  const VolumeAccess access = volume_access(options.volumes);
  if (is_mesh_name(options.volume)) return show_mesh(options, find_volume(options.volume, access.folders));
  VolumeChoices choices{.nan = access.nan, .time_step = options.time_step};
  if (!options.spacing.empty()) choices.spacing = {options.spacing[0], options.spacing[1], options.spacing[2]};
  const Volume volume = read_volume(find_volume(options.volume, access.folders), choices, access.memory_limit);
  for (const std::string& warning : warnings_of(volume, volume.file.string())) say(warning);
  const auto description = describe_volume(volume);
  print(options.json ? description_json(description).dump(2) + "\n" : description_text(description));
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<InfoOptions>();
  add.operand("volume", options->volume, "File, or name in the data folders");
  add.flag("--json", options->json, "As JSON");
  add.data(options->volumes);
  add.nan(options->volumes);
  add.time_step(options->time_step);
  add.spacing(options->spacing);
  return [options] { return show_volume(*options); };
}

}  // namespace

extern const Command info_command;
const Command info_command{
    .name = "info",
    .summary = "Describe a volume or a mesh: header, range, levels in use, signs of damage",
    .example = "raytruth info ch2.nii.gz",
    .notes =
        "Volumes are NRRD (.nrrd, .nhdr), NIfTI (.nii, .nii.gz, .hdr) and NumPy arrays (.npy); `raytruth list\n"
        "volumes` names those in the data folders. Every other format comes in by NumPy: an array of the shape\n"
        "(z, y, x), of integers or of float32 or float64, as\n"
        "  numpy.save(\"head.npy\", array)      # array[z, y, x]\n"
        "  raytruth info head.npy --spacing 0.5 0.5 1.2      # x y z\n"
        "and in a scene, a case or an experiment\n"
        "  \"volume\": \"head.npy\", \"spacing\": [0.5, 0.5, 1.2]\n"
        "Beside \"volume\" there may also stand \"nan\": VALUE, for voxels that are NaN, and \"time_step\": N, for\n"
        "one volume of a series, from 0.\n"
        "Tetrahedral meshes are VTU (.vtu) and legacy VTK (.vtk) files, both as ASCII; they stand in the signal\n"
        "{\"kind\": \"tetrahedra\", \"mesh\": FILE, ...} of a case and as \"mesh\": FILE, in place of \"volume\", in a "
        "scene.",
    .describe = describe};

}  // namespace raytruth
