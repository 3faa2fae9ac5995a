#pragma once

#include "raytruth/render/camera.hpp"

#include <nlohmann/json_fwd.hpp>

namespace raytruth {

/// A camera as scenes state it: eye, target and up in world coordinates, and height or fov_y (degrees), and size.
nlohmann::ordered_json camera_json(const Camera& camera);

}  // namespace raytruth
