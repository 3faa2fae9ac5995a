#pragma once

#include "raytruth/advice/advice.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/scene_document.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// What is asked beside the scene.
struct AdviceOptions {
  std::string error;        ///< a number > 0, or "invisible"
  std::string of = "rmse";  ///< one of error_kind_names: what the number bounds
  std::int64_t views = 6;   ///< of a scene without a camera
  std::uint64_t seed = 1;
  std::int64_t most_rays = 16384;
  VolumeAccess volumes = {};
};

/// Half a step of 8 bits: an image that is no farther off, encoded as sRGB, shows no value that is off by more than
/// one.
inline constexpr double invisible_error = 0.5 / 255;

/// A request, and what was understood of the scene's document.
struct AdviceDocument {
  AdviceRequest request;
  nlohmann::ordered_json volume = {};
  nlohmann::ordered_json transfer_function = {};
  std::vector<std::string> warnings = {};
};

/// Reads a scene, which need not say a scheme, a step or a table; where it says no camera, views from all around are
/// taken. Adds to its warnings what of the volume and the transfer function looks like a mistake. Throws InputError.
AdviceDocument read_advice_document(const JsonReader& json, const AdviceOptions& options);

}  // namespace raytruth
