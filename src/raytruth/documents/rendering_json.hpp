#pragma once

#include "raytruth/render/renderer.hpp"

#include <nlohmann/json_fwd.hpp>

namespace raytruth {

/// How well a rendering of `reference` is known: whether it is `certified`, `error_bound`, proven, or for lit images `measured_radius`, an
/// estimate, both the largest of all pixels; `bound_of`, what it is a bound of; and, beside the number of pixels that
/// are known less well than was asked for, what was asked for, which pixel is known least, and what that means.
nlohmann::ordered_json radius_json(const Rendering& rendering);

/// The radius of each pixel's numbers as a file in binary32 holds them: what rounding them adds is in it, rounded up.
std::vector<double> radii_in_binary32(const Rendering& rendering);

}  // namespace raytruth
