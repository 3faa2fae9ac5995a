#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/volume/grid.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// A volume that a JSON document names.
struct SourcedVolume {
  Grid grid;
  std::string file;  ///< its name without the folder
  bool repaired = false;
  std::vector<std::string> warnings;  ///< one line each
};

/// Reads the volume at `owner`'s member "volume": a path, relative to the document, or a name that is looked for in
/// `folders`. The member "repair" may ask to undo the loss of the first byte; a file that bears the sign of it without
/// being repaired makes a warning.
/// Throws VolumeAbsent where there is no such file, InputError with the place in the document for everything else.
SourcedVolume read_sourced_volume(const JsonReader& owner, const std::vector<std::filesystem::path>& folders);

/// The voxels that stand in a document: {"size": [nx, ny, nz], "values": [...]}, x fastest, and "spacing" if
/// `has_spacing`. Throws InputError.
Grid read_inline_grid(const JsonReader& json, bool has_spacing = false);

/// The file of that volume. Throws VolumeAbsent.
std::filesystem::path find_sourced_volume(const JsonReader& owner, const std::vector<std::filesystem::path>& folders);

/// Whether `owner` asks for the repair. Throws InputError for what is no repair.
bool asks_for_repair(const JsonReader& owner);

/// The warning that a file bears the sign of a lost first byte.
std::string lost_first_byte_warning(const std::string& file);

}  // namespace raytruth
