#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/outside_program.hpp"
#include "raytruth/documents/volume_source.hpp"
#include "raytruth/render/scene.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// What the command line adds to a scene's transfer function.
struct SceneOptions {
  VolumeAccess volumes;
  std::optional<std::string> opacity;  ///< file
  bool ignores_gradient_opacity = false;
  bool only_renders = false;  ///< so that a mesh in place of the volume, and a deformation of it, may be there
};

/// A scene as its JSON says it; experiments/schemas/scene.json describes it.
struct SceneFile {
  Scene scene;
  nlohmann::ordered_json volume = {};             ///< where it, or the mesh, comes from
  nlohmann::ordered_json transfer_function = {};  ///< how it was understood
  nlohmann::ordered_json fitted_camera = {};      ///< as a scene would say it; null: the scene has its own
  std::vector<std::string> warnings = {};         ///< one line each
  std::optional<OutsideProgram> program = {};     ///< that renders it, in place of the scene's scheme
  nlohmann::ordered_json document = {};           ///< all of it, for a program
};

/// Throws InputError.
SceneFile read_scene(const JsonReader& json, const SceneOptions& options);

}  // namespace raytruth
