#pragma once

#include "raytruth/render/technique.hpp"

namespace raytruth {

/// Tries the scene's scheme on a ray of two cells, so that what it refuses is refused before any pixel. Throws
/// InputError.
void refuse_unsuitable_scheme(const PreparedScene& prepared);

}  // namespace raytruth
