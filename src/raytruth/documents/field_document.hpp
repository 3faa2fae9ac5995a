#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/volume_source.hpp"
#include "raytruth/signals/fields/generated_fields.hpp"
#include "raytruth/volume/grid.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <variant>
#include <vector>

namespace raytruth {

/// Where voxels come from, as a document says it: a generator and its options, a file, or the document itself.
using FieldDocument = std::variant<GeneratedField, VolumeFile, Grid>;

/// Reads an item of an experiment's "fields": {"name", "kind"} and the options of that kind, those of a file for the
/// kind "volume". `seed` is that of a random field that states none. Throws InputError.
FieldDocument read_named_field(const JsonReader& json, std::uint64_t seed);

/// Reads the member "volume" of a scene or of a case's signal, and beside it what is said of a file
/// (volume_source.hpp). It is an object of a "kind" and its options, the text of a file's path or name, or voxels:
/// {"size": [nx, ny, nz], "values": [...]}, x fastest, and "spacing" if `has_spacing`. Throws InputError.
FieldDocument read_volume_member(const JsonReader& owner, bool has_spacing);

/// Gives a field of an experiment the options that it leaves out, but for its seed, which is the experiment's. What is
/// no field is left as it is.
void fill_in_field_defaults(nlohmann::ordered_json& field);

/// The voxels. Throws VolumeAbsent where no folder holds the file, InputError for everything else.
SourcedVolume make_volume(const FieldDocument& field, const VolumeAccess& volumes);

}  // namespace raytruth
