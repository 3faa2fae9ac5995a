#include "raytruth/documents/volume_source.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace raytruth {

VolumeFile read_volume_file(const JsonReader& owner) {
  const auto repair = owner.find("repair");
  return {.name = owner.at("volume").text(),
          .is_repaired = repair && repair->word({"first_byte"}) == "first_byte",
          .owner = owner};
}

std::filesystem::path find_volume_file(const VolumeFile& file, const std::vector<std::filesystem::path>& folders) {
  auto beside = file.owner.resolve(file.name);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(beside, ignored)) return beside;
  if (file.name.find('/') != std::string::npos) throw VolumeAbsent(one_line(file.name) + ": no such file");
  return find_volume(file.name, folders);
}

std::string lost_first_byte_warning(const std::string& file) {
  return fmt::format(
      "warning: {}: its last byte is 0x0A, the sign of a stream that lost its first byte; \"repair\": \"first_byte\" "
      "undoes it",
      file);
}

SourcedVolume read_sourced_volume(const VolumeFile& file, const std::vector<std::filesystem::path>& folders) {
  const auto path = find_volume_file(file, folders);
  Volume volume = file.owner.at("volume").blame_for([&path] { return read_volume(path); });
  if (file.is_repaired) file.owner.at("repair").blame_for([&volume] { repair_first_byte(volume); });
  SourcedVolume result{.grid = std::move(volume.grid), .file = path.filename().string(), .repaired = file.is_repaired};
  if (volume.lost_first_byte)
    result.warnings.push_back(file.owner.place() + ": " + lost_first_byte_warning(result.file));
  return result;
}

}  // namespace raytruth
