#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/volume/grid.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace raytruth {

/// A volume's file as a document names it.
struct VolumeFile {
  std::string name;          ///< a path, relative to the document, or a name that is looked for in data folders
  bool is_repaired = false;  ///< the loss of the first byte is undone
  JsonReader owner;          ///< whose members "volume" and "repair" say so
};

/// Reads the members "volume" and "repair" of `owner`. Throws InputError.
VolumeFile read_volume_file(const JsonReader& owner);

/// Where it is. Throws VolumeAbsent.
std::filesystem::path find_volume_file(const VolumeFile& file, const std::vector<std::filesystem::path>& folders);

/// Voxels from wherever a document says.
struct SourcedVolume {
  Grid grid;
  std::string file = {};  ///< its name without the folder; empty: none
  bool repaired = false;
  std::vector<std::string> warnings = {};  ///< one line each
};

/// Reads the file; one that bears the sign of a lost first byte without being repaired makes a warning.
/// Throws VolumeAbsent where there is no such file, InputError with the place in the document for everything else.
SourcedVolume read_sourced_volume(const VolumeFile& file, const std::vector<std::filesystem::path>& folders);

/// The warning that a file bears the sign of a lost first byte.
std::string lost_first_byte_warning(const std::string& file);

}  // namespace raytruth
