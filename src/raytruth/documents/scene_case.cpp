#include "raytruth/documents/scene_case.hpp"

#include "raytruth/images/image_error.hpp"
#include "raytruth/images/structural_similarity.hpp"
#include "raytruth/render/renderer.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace raytruth {

namespace {

template <class Number>
nlohmann::ordered_json or_null(const std::optional<Number>& number) {
  return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
}

}  // namespace

nlohmann::ordered_json image_error_json(const Image& image, const Image& reference) {
  const ImageError error = image_error(image, reference);
  nlohmann::ordered_json result{
      {"danskin_hanrahan", nullptr}, {"rmse", error.rmse},
      {"psnr", or_null(error.psnr)}, {"psnr_peak", 1},
      {"maximum", error.maximum},    {"maximum_pixel", error.place},
      {"bias", error.bias},          {"ssim", or_null(structural_similarity(image, reference))}};
  if (error.relative) result["danskin_hanrahan"] = 100 * *error.relative;
  return result;
}

bool is_scene_case(const JsonReader& json) { return json.is_object() && json.find("camera"); }

nlohmann::ordered_json evaluate(const SceneFile& asked) {
  Scene scene = asked.scene;
  scene.scheme = "reference";
  scene.table.reset();
  if (scene.shading) scene.shading->method = nullptr;
  const Rendering truth = Renderer(std::move(scene)).render();
  const double radius = *std::max_element(truth.radii.begin(), truth.radii.end());
  nlohmann::ordered_json result{{"size", asked.scene.camera.size},
                                {"reference", {{truth.is_certified ? "error_bound" : "measured_radius", radius}}},
                                {"scheme", asked.scene.scheme}};
  if (asked.scene.scheme != "reference")
    result["error"] = image_error_json(Renderer(asked.scene).render().image, truth.image);
  return result;
}

}  // namespace raytruth
