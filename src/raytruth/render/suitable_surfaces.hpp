#pragma once

#include "raytruth/render/scene.hpp"

namespace raytruth {

/// Throws InputError where a scene with isosurfaces cannot be rendered: for a scheme that lacks its numbers, and for
/// shading that does not go with it. Surfaces are lit by a normal of their own, isoslabs by a method from the normals
/// at samples, and matter beside either is not lit.
void refuse_unsuitable_surfaces(const Scene& scene);

}  // namespace raytruth
