#pragma once

#include "raytruth/signals/field_kind.hpp"
#include "raytruth/skipping/occupied_blocks.hpp"

#include <optional>

namespace raytruth {

/// How far a field leaves the range of its voxels, in units of that: the tensor product of Catmull-Rom cubics does.
double field_overshoot(FieldKind field);

/// What the blocks of a field are asked under these bounds, where it is sampled at this step, or at cells' borders and
/// midpoints. Corrected ones hold: their ranges are those of all voxels that a sample, and the samples that a virtual
/// one is made of, can reach, and as much wider as field and virtual samples leave those of their data.
BlockRefinement block_refinement(FieldKind field, const std::optional<double>& step, BlockBounds bounds);

}  // namespace raytruth
