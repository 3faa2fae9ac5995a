#pragma once

#include "raytruth/render/scene.hpp"

#include <cstdint>

namespace raytruth {

/// What a scene's empty-space skipping leaves out of its image.
struct SkippedSlabs {
  std::int64_t slabs = 0;    ///< of all rays
  std::int64_t skipped = 0;  ///< those left out
  std::int64_t wrong = 0;    ///< and of these, those that show something
  std::int64_t blocks = 0;   ///< of the grid
  std::int64_t skipped_blocks = 0;
  std::int64_t wrong_blocks = 0;  ///< skipped ones in which such a slab has its middle
};

/// Counts slabs as `virtual_catmull_rom_3` at the scene's step sees them: four from sample to sample, linear between
/// true and virtual samples. One shows something where not all of its scalars are clear.
/// Throws InputError for scenes without a step or without empty-space skipping.
SkippedSlabs count_skipped_slabs(const Scene& scene);

}  // namespace raytruth
