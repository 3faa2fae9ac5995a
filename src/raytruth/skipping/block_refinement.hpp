#pragma once

#include "raytruth/signals/field_kind.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/skipping/occupied_blocks.hpp"
#include "raytruth/volume/grid.hpp"

#include <optional>

namespace raytruth {

/// What the blocks of a field are asked under these bounds, where it is sampled at this step, or at cells' borders and
/// midpoints. Corrected ones hold: their ranges are those of all voxels that a sample, and the samples that a virtual
/// one is made of, can reach, and as much wider as field and virtual samples leave those of their data.
BlockRefinement block_refinement(FieldKind field, const std::optional<double>& step, BlockBounds bounds);

/// A margin that is more than what a displacement by 10^-9 of a voxel changes in a field of this grid, for no cubic
/// kernel has a derivative above 16/3 per axis and unit of the voxels' range; and more than a chain's rounding, some
/// units in the last place of its voxels.
double margin_of(const Grid& grid);

/// Blocks that hold for every point of every ray through a field: no block that is left out has anything to see.
template <class Field>
OccupiedBlocks certain_blocks(const Field& field, const ClearScalars& clear) {
  constexpr std::int64_t side = 8;
  return {field.grid(),
          clear,
          side,
          {.growth = field.kind() == FieldKind::trilinear ? 0 : 1,
           .overshoot = field_overshoot(field.kind()),
           .margin = margin_of(field.grid())}};
}

}  // namespace raytruth
