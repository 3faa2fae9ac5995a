#include "raytruth/documents/volume_source.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string_view>
#include <system_error>
#include <utility>

namespace raytruth {

namespace {

VolumeChoices read_choices(const JsonReader& owner) {
  VolumeChoices choices;
  if (const auto nan = owner.find("nan")) choices.nan = nan->number();
  if (const auto step = owner.find("time_step")) choices.time_step = step->integer(0, most_voxels - 1);
  if (const auto spacing = owner.find("spacing")) {
    const auto lengths = spacing->items();
    if (lengths.size() != 3) spacing->refuse_value("a list of 3 numbers > 0");
    choices.spacing.emplace();
    for (std::size_t axis = 0; axis < 3; ++axis) (*choices.spacing)[axis] = lengths[axis].positive_number();
  }
  return choices;
}

}  // namespace

VolumeFile read_volume_file(const JsonReader& owner) {
  const auto repair = owner.find("repair");
  return {.name = owner.at("volume").text(),
          .is_repaired = repair && repair->word({"first_byte"}) == "first_byte",
          .choices = read_choices(owner),
          .owner = owner};
}

std::string reading_of(const VolumeFile& file) {
  std::string text = file.is_repaired ? " repaired" : "";
  for (const std::string_view member : {"nan", "time_step", "spacing"})
    if (const auto stated = file.owner.find(member)) text += fmt::format(" {} {}", member, stated->json().dump());
  return text;
}

std::filesystem::path find_volume_file(const VolumeFile& file, const VolumeAccess& volumes) {
  if (volumes.in_memory.contains(file.name)) return file.name;
  auto beside = file.owner.resolve(file.name);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(beside, ignored)) return beside;
  if (file.name.find('/') != std::string::npos) throw VolumeAbsent(one_line(file.name) + ": no such file");
  return find_volume(file.name, volumes.folders);
}

std::vector<std::string> warnings_of(const Volume& volume, const std::string& file) {
  std::vector<std::string> warnings;
  for (const std::string& warning : volume.warnings) warnings.push_back(fmt::format("warning: {}: {}", file, warning));
  if (volume.lost_first_byte)
    warnings.push_back(
        fmt::format("warning: {}: its last byte is 0x0A, the sign of a stream that lost its first byte; "
                    "\"repair\": \"first_byte\" undoes it",
                    file));
  return warnings;
}

SourcedVolume read_sourced_volume(const VolumeFile& file, const VolumeAccess& volumes) {
  if (const auto found = volumes.in_memory.find(file.name); found != volumes.in_memory.end()) {
    for (const std::string_view member : {"repair", "nan", "time_step"})
      if (const auto stated = file.owner.find(member)) stated->refuse_value(fmt::format("{} of a file only", member));
    SourcedVolume result{.grid = *found->second, .file = file.name};
    if (file.choices.spacing) result.grid.spacing = *file.choices.spacing;
    return result;
  }
  const auto path = find_volume_file(file, volumes);
  VolumeChoices choices = file.choices;
  if (!choices.nan) choices.nan = volumes.nan;
  Volume volume = file.owner.at("volume").blame_for([&] { return read_volume(path, choices, volumes.memory_limit); });
  if (file.is_repaired) file.owner.at("repair").blame_for([&volume] { repair_first_byte(volume); });
  SourcedVolume result{.grid = std::move(volume.grid),
                       .file = path.filename().string(),
                       .repaired = file.is_repaired,
                       .has_spacing = volume.has_spacing};
  for (const std::string& warning : warnings_of(volume, result.file))
    result.warnings.push_back(file.owner.place() + ": " + warning);
  return result;
}

}  // namespace raytruth
