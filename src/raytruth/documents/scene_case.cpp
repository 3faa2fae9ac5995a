#include "raytruth/documents/scene_case.hpp"

#include "raytruth/documents/case_json.hpp"
#include "raytruth/documents/image_comparison.hpp"
#include "raytruth/documents/outside_image.hpp"
#include "raytruth/documents/rendering_json.hpp"
#include "raytruth/render/renderer.hpp"

#include <nlohmann/json.hpp>

#include <utility>

namespace raytruth {

namespace {

/// Adds the errors of a program's image.
void add_outside_error(const SceneFile& asked, bool runs_programs, const Image& truth, nlohmann::ordered_json& result) {
  try {
    if (!runs_programs) throw OutsideRefusal(std::string(why_not_run));
    const OutsideImage found = outside_image(*asked.program, asked.scene, asked.document);
    if (found.version) result["version"] = *found.version;
    result["error"] = image_error_json(found.image, truth);
  } catch (const OutsideRefusal& refusal) {
    result["error"] = refused(refusal.what());
  }
}

}  // namespace

bool is_scene_case(const JsonReader& json) {
  return json.is_object() &&
         (json.find("camera") || ((json.find("volume") || json.find("mesh")) && json.find("scheme")));
}

nlohmann::ordered_json evaluate(const SceneFile& asked, bool runs_programs) {
  Scene scene = asked.scene;
  scene.scheme = "reference";
  scene.table.reset();
  if (scene.shading) scene.shading->method = nullptr;
  scene.covers_camera = true;
  const Rendering truth = Renderer(std::move(scene)).render();
  nlohmann::ordered_json result{{"size", asked.scene.camera.size},
                                {"border", asked.scene.mesh ? std::string_view("mesh") : name_of(asked.scene.border)},
                                {"reference", radius_json(truth)},
                                {"scheme", asked.program ? asked.program->name : asked.scene.scheme}};
  if (!asked.fitted_camera.is_null()) result["fitted_camera"] = asked.fitted_camera;
  if (!asked.warnings.empty()) result["warnings"] = asked.warnings;
  if (asked.program)
    add_outside_error(asked, runs_programs, truth.image, result);
  else if (asked.scene.scheme != "reference")
    result["error"] = image_error_json(Renderer(asked.scene).render().image, truth.image);
  return result;
}

}  // namespace raytruth
