#pragma once

#include "raytruth/documents/scene_document.hpp"
#include "raytruth/images/image.hpp"

#include <nlohmann/json_fwd.hpp>

namespace raytruth {

/// How far an image is from a reference, in the words of `raytruth compare`: Danskin and Hanrahan's error in per cent,
/// RMSE, PSNR with its peak, the maximum with its pixel, bias and SSIM. Throws InputError for images of different size.
nlohmann::ordered_json image_error_json(const Image& image, const Image& reference);

/// Whether a case for `eval` is a scene.
bool is_scene_case(const JsonReader& json);

/// What `eval` answers of a scene: the errors of its image against that of `reference`, and how well this is known.
nlohmann::ordered_json evaluate(const SceneFile& asked);

}  // namespace raytruth
