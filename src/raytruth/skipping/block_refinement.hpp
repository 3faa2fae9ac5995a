#pragma once

#include "raytruth/signals/field_kind.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/skipping/occupied_blocks.hpp"
#include "raytruth/skipping/overshoot.hpp"
#include "raytruth/volume/grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace raytruth {

/// What the blocks of a field are asked under these bounds, where it is sampled at this step, or at cells' borders and
/// midpoints. Corrected ones hold: their ranges are those of all voxels that a sample, and the samples that a virtual
/// one is made of, can reach, and as much wider as field and virtual samples leave those of their data.
inline BlockRefinement block_refinement(FieldKind field, const std::optional<double>& step, BlockBounds bounds) {
  constexpr double of_virtual_samples = 1.0 / 8;  // Lee 2010, eq. 8
  constexpr double longest_chord = std::numbers::sqrt3;
  switch (bounds) {
    case BlockBounds::unrefined:
      return {};
    case BlockBounds::printed:
      return {.overshoot = of_virtual_samples};
    default:
      const double of_field = field_overshoot(field);
      return {.growth = proven_growth(BlockRegion::cells, step.value_or(longest_chord)),
              .overshoot = of_field + of_virtual_samples * (1 + 2 * of_field)};
  }
}

/// A margin that is more than what a displacement by this many voxels, or by 10^-9 of one, changes in a field of this
/// grid, for no cubic kernel has a derivative above 16/3 per axis and unit of the voxels' range; and more than a
/// chain's rounding, some units in the last place of its voxels.
inline double margin_of(const Grid& grid, double displacement) {
  const auto [low, high] = grid.range();
  return 1e-7 * std::max(1.0, displacement / 1e-9) * std::max({high - low, std::abs(low), std::abs(high)});
}

/// Blocks that hold for every point of every ray through a field, displaced by up to so many voxels: no block that is
/// left out has anything to see.
template <class Field>
OccupiedBlocks certain_blocks(const Field& field, const ClearScalars& clear, double displacement) {
  constexpr std::int64_t side = 8;
  return {field.grid(),
          clear,
          side,
          {.growth = field.kind() == FieldKind::trilinear ? 0 : 1,
           .overshoot = field_overshoot(field.kind()),
           .margin = margin_of(field.grid(), displacement)}};
}

}  // namespace raytruth
