#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/schemes/radius_axis.hpp"

#include <nlohmann/json.hpp>

namespace raytruth {

/// The curvature axis of a quadratic table: {"axis", "low", "high", "count", "look_up"}; `standard` says the rest.
/// Throws InputError, as `check` does too.
RadiusAxis read_radius_axis(const JsonReader& json, const RadiusAxis& standard);

nlohmann::ordered_json radius_axis_json(const RadiusAxis& axis);

}  // namespace raytruth
