#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <string>
#include <vector>

namespace raytruth {

/// Reads a transfer function: {"points": [{"s", "extinction", "color"}, ...]}, or {"points": [{"s", "opacity",
/// "color"},
/// ...], "unit_length"}, or the path of a JSON file that holds one of these. Adds a line to `warnings` where an opacity
/// is clamped. Throws InputError.
PiecewiseLinear read_transfer_function(const JsonReader& json, std::vector<std::string>& warnings);

}  // namespace raytruth
