#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/shading/lighting.hpp"
#include "raytruth/shading/shaded_slab.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace raytruth {

/// A shaded slab for `eval`; experiments/schemas/case.json describes its JSON.
struct SlabCase {
  ShadedSlab slab;
  PiecewiseLinear transfer;
  nlohmann::ordered_json transfer_description =
      {};  ///< of another program's file; null: the points are of this program
  Emission emission = Emission::associated;
  Lighting lighting;
  std::vector<std::string> schemes;  ///< of catalogue::shadings(), or "reference"
};

/// Whether a case asks for a slab.
bool is_slab_case(const JsonReader& json);

/// Adds a line to `warnings` for what of a transfer function was mended or left out. Throws InputError.
SlabCase read_slab_case(const JsonReader& json, std::vector<std::string>& warnings);

/// What `eval` answers.
nlohmann::ordered_json evaluate(const SlabCase& asked);

}  // namespace raytruth
