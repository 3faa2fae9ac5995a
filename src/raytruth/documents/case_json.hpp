#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/outside_program.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/transfer/emission.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

// What cases of all kinds share: the reading of their parts and the writing of their answers.
namespace raytruth {

inline constexpr std::string_view why_not_finite = "its error is beyond the range of binary64";

/// A list of three numbers.
Vector3<double> read_vector(const JsonReader& json);

/// The member "emission", `associated` where there is none.
Emission read_emission(const JsonReader& json);

/// The member "border", which says where the volume of a scene or a signal ends: `half_voxel` where there is none.
Border read_border(const JsonReader& json);

/// Words of the list, each once: "reference" or one of `names`. Programs go to `programs`, and are refused without it.
std::vector<std::string> read_schemes(const JsonReader& json, const std::vector<std::string_view>& names,
                                      std::vector<OutsideProgram>* programs = nullptr);

nlohmann::ordered_json color_json(const Vector3<double>& color);

/// {"status": "refused", "why": ...}
nlohmann::ordered_json refused(std::string_view why);

/// Says so where a reference's bound is wider than is asked for.
void add_status(nlohmann::ordered_json& answer, Status status);

/// Reads {"kind": "cells"} or {"kind": "constant", "step": 0.25}. Throws InputError.
Sampling read_sampling(const JsonReader& json);

/// Checks a document's member "raytruth", which may say what the document is and of which version of its form, as
/// "scene/1". Throws InputError where it says something else.
void check_form(const JsonReader& json, std::string_view form);

}  // namespace raytruth
