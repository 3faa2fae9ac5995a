#include "raytruth/documents/camera_json.hpp"

#include <nlohmann/json.hpp>

#include <variant>

namespace raytruth {

nlohmann::ordered_json camera_json(const Camera& camera) {
  nlohmann::ordered_json json{{"eye", camera.eye}, {"target", camera.target}, {"up", camera.up}};
  if (const auto* const perspective = std::get_if<Perspective>(&camera.projection))
    json["fov_y"] = perspective->fov_y;
  else
    json["height"] = std::get<Orthographic>(camera.projection).height;
  json["size"] = camera.size;
  return json;
}

}  // namespace raytruth
