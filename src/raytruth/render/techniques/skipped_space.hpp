#pragma once

#include "raytruth/render/scene.hpp"
#include "raytruth/skipping/block_refinement.hpp"
#include "raytruth/skipping/parts_of_ray.hpp"

#include <memory>

namespace raytruth {

/// The blocks that a scene's `empty_space` asks for; null where it asks for none.
template <class Field>
std::shared_ptr<const OccupiedBlocks> asked_blocks(const Scene& scene, const Field& field) {
  if (!scene.empty_space) return nullptr;
  return std::make_shared<const OccupiedBlocks>(field.grid(), ClearScalars(scene.transfer, scene.emission),
                                                scene.empty_space->block,
                                                block_refinement(scene.field, scene.step, scene.empty_space->bounds));
}

}  // namespace raytruth
