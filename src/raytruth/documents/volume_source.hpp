#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/volume/files/read_volume.hpp"
#include "raytruth/volume/grid.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// Where volumes are found, and what is said of all of them beside the documents.
struct VolumeAccess {
  std::vector<std::filesystem::path> folders = {};
  std::optional<double> nan = {};  ///< what voxels become that are NaN, where a document does not say
  std::uint64_t memory_limit = memory_of_machine();
  std::map<std::string, std::shared_ptr<const Grid>> in_memory = {};  ///< by the names that documents call them
};

/// A volume's file as a document names it.
struct VolumeFile {
  std::string name;          ///< a path, relative to the document, or a name that is looked for in data folders
  bool is_repaired = false;  ///< the loss of the first byte is undone
  VolumeChoices choices = {};
  JsonReader owner;  ///< whose members "volume", "repair", "nan", "time_step" and "spacing" say so
};

/// Reads the members "volume", "repair", "nan", "time_step" and "spacing" of `owner`. Throws InputError.
VolumeFile read_volume_file(const JsonReader& owner);

/// What is said of the file beside its name, as text: the same text, the same voxels.
std::string reading_of(const VolumeFile& file);

/// Where it is; of one in memory its name. Throws VolumeAbsent.
std::filesystem::path find_volume_file(const VolumeFile& file, const VolumeAccess& volumes);

/// Voxels from wherever a document says.
struct SourcedVolume {
  Grid grid;
  std::string file = {};  ///< its name without the folder; empty: none
  bool repaired = false;
  bool has_spacing = true;                 ///< the file or the document states it; otherwise it is 1
  std::vector<std::string> warnings = {};  ///< one line each
};

/// Reads the file; what the reader mended, and the sign of a lost first byte without a repair, make warnings.
/// Throws VolumeAbsent where there is no such file, InputError with the place in the document for everything else.
SourcedVolume read_sourced_volume(const VolumeFile& file, const VolumeAccess& volumes);

/// What there is to say of a volume that was read, each with the name of the file.
std::vector<std::string> warnings_of(const Volume& volume, const std::string& file);

}  // namespace raytruth
