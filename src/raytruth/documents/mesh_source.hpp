#pragma once

#include "raytruth/cells/tetrahedral_field.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/volume_source.hpp"

#include <memory>
#include <string>
#include <vector>

namespace raytruth {

/// Tetrahedra from wherever a document says.
struct SourcedMesh {
  std::shared_ptr<const TetrahedralField> field;
  std::string file = {};  ///< its name without the folder; empty: none
  std::vector<std::string> warnings = {};
};

/// Whether the member "mesh" of a signal or a scene is a file of tetrahedra: a path, or {"file", "array"}; where it is.
/// Throws VolumeAbsent where no folder holds the file, InputError for everything else.
std::filesystem::path find_mesh(const JsonReader& owner, const std::string& name, const VolumeAccess& volumes);

/// Reads a "mesh": the path of a .vtu or .vtk file; {"file": ..., "array": NAME}; {"points", "tetrahedra", and
/// "scalars" or "cell_scalars"}; or {"volume": ..., "split": 5 or 6, "parity": "even" or "odd"}, and beside "volume"
/// what is said of a file, in voxel coordinates.
SourcedMesh read_mesh_source(const JsonReader& mesh, const VolumeAccess& volumes);

/// Reads the members "volume", "split" and "parity" of `owner`.
SourcedMesh read_split_volume(const JsonReader& owner, const VolumeAccess& volumes);

}  // namespace raytruth
