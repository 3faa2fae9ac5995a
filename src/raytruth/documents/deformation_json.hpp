#pragma once

#include "raytruth/deformation/lattice_proof.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>

namespace raytruth {

/// Reads "deformation" (experiments/schemas/case.json) of a volume whose object coordinates are voxels times `spacing`.
/// Its box is the volume's where none is stated, its border with it. Refuses lattices that do not hold the volume,
/// fold, or lay parts of it over each other.
Deformation read_deformation(const JsonReader& json, const Grid& grid, Border border,
                             const std::array<double, 3>& spacing);

}  // namespace raytruth
