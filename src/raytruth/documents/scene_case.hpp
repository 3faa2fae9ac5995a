#pragma once

#include "raytruth/documents/scene_document.hpp"

#include <nlohmann/json_fwd.hpp>

namespace raytruth {

/// Whether a case for `eval` is a scene.
bool is_scene_case(const JsonReader& json);

/// What `eval` answers of a scene: the errors of its image against that of `reference`, and how well this is known.
/// Where a program renders it that must not run, or gives no image, the errors are refused.
nlohmann::ordered_json evaluate(const SceneFile& asked, bool runs_programs);

}  // namespace raytruth
