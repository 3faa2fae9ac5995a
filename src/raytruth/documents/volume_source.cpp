#include "raytruth/documents/volume_source.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace raytruth {

Grid read_inline_grid(const JsonReader& json, bool has_spacing) {
  if (has_spacing)
    json.only({"size", "values", "spacing"});
  else
    json.only({"size", "values"});
  const auto sizes = json.at("size").items();
  if (sizes.size() != 3) json.at("size").refuse_value("a list of 3 sizes");
  Grid grid;
  std::int64_t voxels = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.size[axis] = sizes[axis].integer(1, most_voxels);
    if (grid.size[axis] > most_voxels / voxels) json.at("size").refuse("more voxels than 2^33", "fewer");
    voxels *= grid.size[axis];
  }
  grid.values = json.at("values").numbers();
  if (grid.values.size() != static_cast<std::size_t>(voxels))
    json.at("values").refuse_value(fmt::format("a list of {} numbers, as size says,", voxels));
  if (const auto spacing = json.find("spacing")) {
    const auto lengths = spacing->items();
    if (lengths.size() != 3) spacing->refuse_value("a list of 3 numbers > 0");
    for (std::size_t axis = 0; axis < 3; ++axis) grid.spacing[axis] = lengths[axis].positive_number();
  }
  return grid;
}

std::filesystem::path find_sourced_volume(const JsonReader& owner, const std::vector<std::filesystem::path>& folders) {
  const JsonReader place = owner.at("volume");
  const std::string name = place.text();
  auto beside = place.resolve(name);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(beside, ignored)) return beside;
  if (name.find('/') != std::string::npos) throw VolumeAbsent(one_line(name) + ": no such file");
  return find_volume(name, folders);
}

bool asks_for_repair(const JsonReader& owner) {
  const auto repair = owner.find("repair");
  return repair && repair->word({"first_byte"}) == "first_byte";
}

std::string lost_first_byte_warning(const std::string& file) {
  return fmt::format(
      "warning: {}: its last byte is 0x0A, the sign of a stream that lost its first byte; \"repair\": \"first_byte\" "
      "undoes it",
      file);
}

SourcedVolume read_sourced_volume(const JsonReader& owner, const std::vector<std::filesystem::path>& folders) {
  const bool repaired = asks_for_repair(owner);
  const auto file = find_sourced_volume(owner, folders);
  Volume volume = owner.at("volume").blame_for([&file] { return read_volume(file); });
  if (repaired) owner.at("repair").blame_for([&volume] { repair_first_byte(volume); });
  SourcedVolume result{std::move(volume.grid), file.filename().string(), repaired, {}};
  if (volume.lost_first_byte) result.warnings.push_back(owner.place() + ": " + lost_first_byte_warning(result.file));
  return result;
}

}  // namespace raytruth
