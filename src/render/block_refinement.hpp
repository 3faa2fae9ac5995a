#pragma once

#include "render/scene.hpp"

namespace raytruth {

/// What the scene's blocks are asked under these bounds. Corrected ones hold: their ranges are those of all voxels that
/// a sample, and the samples that a virtual one is made of, can reach, and as much wider as field and virtual samples
/// leave those of their data.
BlockRefinement block_refinement(const Scene& scene, BlockBounds bounds);

}  // namespace raytruth
