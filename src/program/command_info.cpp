#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/documents/volume_source.hpp"
#include "raytruth/volume/files/describe_volume.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace raytruth {

namespace {

struct InfoOptions {
  std::string volume;
  bool json = false;
  std::string data;
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
            {"minimum", volume.minimum},
            {"maximum", volume.maximum},
            {"levels", volume.levels},
            {"possible_levels", nullptr},
            {"share_at_minimum", volume.share_at_minimum},
            {"share_of_zeros", volume.share_of_zeros},
            {"constant_layers", volume.constant_layers},
            {"lost_first_byte", volume.lost_first_byte}};
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
  line("spacing", fmt::format("{}", fmt::join(volume.spacing, " ")));
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

int show_volume(const InfoOptions& options) {
  const auto description = describe_volume(read_volume(find_volume(options.volume, volume_folders(options.data))));
  if (description.lost_first_byte) say(lost_first_byte_warning(description.file));
  print(options.json ? description_json(description).dump(2) + "\n" : description_text(description));
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<InfoOptions>();
  add.operand("volume", options->volume, "File, or name in the data folders");
  add.flag("--json", options->json, "As JSON");
  add.data(options->data);
  return [options] { return show_volume(*options); };
}

}  // namespace

extern const Command info_command;
const Command info_command{.name = "info",
                           .summary = "Describe a volume: header, range, levels in use, signs of damage",
                           .example = "raytruth info ch2.nii.gz",
                           .notes = "",
                           .describe = describe};

}  // namespace raytruth
