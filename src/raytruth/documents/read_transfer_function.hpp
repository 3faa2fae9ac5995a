#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <string>
#include <vector>

namespace raytruth {

/// Reads a transfer function: points of "s", "extinction" and "color" in a list "points"; or points of "s", "opacity"
/// and "color", and "unit_length" beside the list; or the path of a JSON file that holds one of these. Adds a line to
/// `warnings` where an opacity is clamped. Throws InputError.
PiecewiseLinear read_transfer_function(const JsonReader& json, std::vector<std::string>& warnings);

}  // namespace raytruth
