#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/documents/transfer_files/transfer_file.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

struct TransferOptions {
  std::string file;
  std::optional<std::string> preset;
  std::optional<std::string> opacity;
  std::optional<std::string> opacity_preset;
  std::vector<double> range;
  std::optional<std::string> scalars;
  std::optional<double> unit_length;
  bool ignores_gradient_opacity = false;
  std::optional<std::string> volume;
  std::string output;
  bool json = false;
  VolumeOptions volumes;
};

constexpr std::size_t most_points_shown = 32;

std::string listing_text(const std::filesystem::path& file, const std::vector<TransferListing>& listings) {
  std::string text =
      fmt::format("{} holds {} transfer functions; --preset NAME shows one\n\n{:<40}  {:>7}  {:>9}  {}\n",
                  file.filename().string(), listings.size(), "name", "colours", "opacities", "scalars");
  for (const TransferListing& listing : listings)
    text += listing.problem.empty()
                ? fmt::format("{:<40}  {:>7}  {:>9}  {} .. {}\n", one_line(listing.name), listing.colors,
                              listing.opacities == 0 ? "none" : fmt::to_string(listing.opacities), listing.range[0],
                              listing.range[1])
                : fmt::format("{:<40}  not read: {}\n", one_line(listing.name), listing.problem);
  return text;
}

Json listing_json(const std::vector<TransferListing>& listings) {
  Json items = Json::array();
  for (const TransferListing& listing : listings) {
    Json item{{"name", listing.name}};
    if (listing.problem.empty())
      item.update(Json{{"colors", listing.colors}, {"opacities", listing.opacities}, {"range", listing.range}});
    else
      item["problem"] = listing.problem;
    items.push_back(std::move(item));
  }
  return items;
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::vector<std::string> items;
  for (const Json& item : value) items.push_back(value_text(item));
  return fmt::format("{}", fmt::join(items, ", "));
}

std::string description_text(const Json& description, const PiecewiseLinear& transfer) {
  std::string text;
  for (const auto& [name, value] : description.items()) {
    std::string words = name;
    std::replace(words.begin(), words.end(), '_', ' ');
    text += fmt::format("{:<16}  {}\n", words, value_text(value));
  }
  const auto& points = transfer.points();
  const bool has_opacity = transfer.is_linear_in_opacity();
  text += fmt::format("\n{:>14}  {:>12}  {}\n", "s", has_opacity ? "opacity" : "extinction", "red, green, blue");
  for (std::size_t i = 0; i < std::min(points.size(), most_points_shown); ++i) {
    const auto& [s, optics] = points[i];
    text += fmt::format("{:>14.7g}  {:>12.7g}  {:.5g}, {:.5g}, {:.5g}\n", s,
                        has_opacity ? transfer.opacities()[i] : optics.extinction, optics.color[0], optics.color[1],
                        optics.color[2]);
  }
  if (points.size() > most_points_shown)
    text += fmt::format("... and {} more; -o FILE.json writes all\n", points.size() - most_points_shown);
  return text;
}

std::string isosurfaces_text(const std::vector<Isosurface>& isosurfaces) {
  if (isosurfaces.empty()) return {};
  std::string text = fmt::format("\n{:>14}  {:>12}  {}\n", "isosurface", "opacity", "red, green, blue");
  for (const auto& [s, opacity, color] : isosurfaces)
    text += fmt::format("{:>14.7g}  {:>12.7g}  {:.5g}, {:.5g}, {:.5g}\n", s, opacity, color[0], color[1], color[2]);
  return text;
}

/// The scene's document that asks for what the command line says.
JsonReader request_of(const TransferOptions& options) {
  const auto absolute = [](const std::string& path) { return std::filesystem::absolute(path).string(); };
  const std::filesystem::path file = absolute(options.file);
  Json document = file.string();
  if (is_transfer_file(file)) {
    document = {{"file", file.string()}};
    if (options.preset) document["preset"] = *options.preset;
    if (options.opacity) document["opacity"] = absolute(*options.opacity);
    if (options.opacity_preset) document["opacity_preset"] = *options.opacity_preset;
    if (!options.range.empty()) document["range"] = options.range;
    if (options.scalars) document["scalars"] = *options.scalars;
    if (options.unit_length) document["unit_length"] = *options.unit_length;
    if (options.ignores_gradient_opacity) document["ignore_gradient_opacity"] = true;
  }
  return JsonReader::from_text(document.dump(), "command line");
}

int show_transfer(const TransferOptions& options) {
  if (!options.preset && is_transfer_file(options.file)) {
    const auto listings = transfer_functions_in(options.file);
    if (listings.size() > 1) {
      if (!options.output.empty())
        throw InputError(
            one_line(fmt::format("command line: found {} transfer functions in {} and no --preset; one of "
                                 "their names is allowed",
                                 listings.size(), options.file)));
      print(options.json ? listing_json(listings).dump(2) + "\n" : listing_text(options.file, listings));
      return 0;
    }
  }
  std::optional<TransferVolume> volume;
  if (options.volume) {
    const VolumeAccess access = volume_access(options.volumes);
    const Volume read =
        read_volume(find_volume(*options.volume, access.folders), {.nan = access.nan}, access.memory_limit);
    volume = transfer_volume(read.grid);
  }
  std::vector<std::string> warnings;
  const TransferDocument read = read_transfer_function(
      request_of(options), {.volume = volume ? &*volume : nullptr, .opacity = {}, .takes_isosurfaces = true}, warnings);
  for (const std::string& warning : warnings) say(warning);
  if (!options.output.empty())
    write_whole(options.output, transfer_function_json(read.transfer, read.isosurfaces).dump(2) + "\n");
  Json description = read.description;
  if (!options.json) {
    print(description_text(description, read.transfer) + isosurfaces_text(read.isosurfaces));
    return 0;
  }
  description.update(transfer_function_json(read.transfer, read.isosurfaces));
  if (!warnings.empty()) description["warnings"] = warnings;
  print(description.dump(2) + "\n");
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<TransferOptions>();
  add.operand("file", options->file, "Transfer function of any program, or of this one");
  add.text("--preset", "NAME", options->preset, "The one of this name, where the file holds several");
  add.text("--opacity", "FILE", options->opacity, "Take the opacities of this file");
  add.text("--opacity-preset", "NAME", options->opacity_preset, "Their name there, where it holds several");
  add.pair("--range", "X", options->range, "Stretch the file's scalars onto LOW to HIGH");
  add.word("--scalars", options->scalars, {"as_stated", "stretched"},
           "Leave the file's scalars, or stretch them over the volume's");
  add.positive_number("--unit-length", options->unit_length,
                      "The length that opacities are of, in smallest spacings, instead of the file's");
  add.flag("--ignore-gradient-opacity", options->ignores_gradient_opacity,
           "Leave out opacity that depends on the gradient");
  add.text("--volume", "VOLUME", options->volume, "The volume it is for: its range, spacing and size");
  add.text("-o", "FILE", options->output, "Write it as this program's JSON");
  add.flag("--json", options->json, "As JSON");
  add.data(options->volumes);
  return [options] { return show_transfer(*options); };
}

}  // namespace

extern const Command transfer_command;
const Command transfer_command{
    .name = "transfer",
    .summary = "Show how a transfer function's file is understood, and write it as JSON",
    .example = "raytruth transfer presets.xml --preset CT-AAA --volume head.nrrd -o transfer.json",
    .notes =
        "Reads colour maps and presets of ParaView (.json, .xml), presets of VolView and ParaView Glance (.json),\n"
        "scenes, presets and volume properties of 3D Slicer (.xml, .mrml, .vp, .vp.json), and transfer functions of\n"
        "Voreen (.tfi) and Inviwo (.itf). Of a file that holds several it lists the names. What -o writes can stand\n"
        "in a scene, a case, a table or an experiment as \"transfer_function\"; so can the file itself:\n"
        "  \"transfer_function\": {\"file\": \"presets.xml\", \"preset\": \"CT-AAA\"}",
    .describe = describe};

}  // namespace raytruth
