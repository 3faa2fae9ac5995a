#pragma once

#include "raytruth/render/scene.hpp"

#include <string>
#include <vector>

namespace raytruth {

/// Adds a line for each thing that leaves an image empty or flat without being an error: a camera of which no ray meets
/// the volume, a transfer function that is clear at all of the volume's values, or whose scalars hardly meet them.
void warn_of_what_is_not_seen(const Scene& scene, std::vector<std::string>& warnings);

/// Adds a line for each sign of a mistaken convention: extinctions that look like opacities, or the other way round; a
/// unit of length that is far from the spacing; visible matter beyond the points; few levels in use.
void warn_of_conventions(const Scene& scene, std::vector<std::string>& warnings);

}  // namespace raytruth
