#include "measures/images/drawing.hpp"

#include "raytruth/documents/scene_document.hpp"

#include <string>

namespace raytruth {

Scene read_drawing(nlohmann::ordered_json drawing, const JsonReader& place) {
  drawing["volume"] = {{"size", {1, 1, 1}}, {"values", {0}}};
  drawing["transfer_function"] = {{"points", {{{"s", 0}, {"extinction", 0}, {"color", {0, 0, 0}}}}}};
  drawing["camera"] = {{"eye", {0, 0, 1}}, {"target", {0, 0, 0}}, {"up", {0, 1, 0}}, {"height", 1}, {"size", {1, 1}}};
  const JsonReader reader = JsonReader::from_json(std::move(drawing), place);
  try {
    SceneFile read = read_scene(reader, {});
    if (read.program) reader.at("scheme").refuse("a program", "one of the schemes");
    return std::move(read.scene);
  } catch (const InputError& error) {
    // It names the file, and behind it the place in the scene.
    throw InputError(place.place() + std::string(error.what()).substr(reader.place().size() - 1));
  }
}

}  // namespace raytruth
