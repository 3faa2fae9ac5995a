#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/render/scene.hpp"

#include <nlohmann/json.hpp>

namespace raytruth {

/// Reads what a scene says of how to render, from JSON that lacks what there is to see (volume, transfer function,
/// camera); these members have no meaning in what it returns. Throws InputError, at `place`.
Scene read_drawing(nlohmann::ordered_json drawing, const JsonReader& place);

}  // namespace raytruth
