#pragma once

#include "render/scene.hpp"

namespace raytruth {

/// How far a field leaves the range of its voxels, in units of that: the tensor product of Catmull-Rom cubics does.
double field_overshoot(FieldKind field);

/// What the scene's blocks are asked under these bounds. Corrected ones hold: their ranges are those of all voxels that
/// a sample, and the samples that a virtual one is made of, can reach, and as much wider as field and virtual samples
/// leave those of their data.
BlockRefinement block_refinement(const Scene& scene, BlockBounds bounds);

}  // namespace raytruth
