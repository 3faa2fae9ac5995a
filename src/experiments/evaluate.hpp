#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/volume_source.hpp"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>

namespace raytruth {

/// What is said of all cases of a document.
struct EvaluateRequest {
  VolumeAccess volumes = {};
  bool runs_programs = false;  ///< programs that cases name among their schemes may run
};

/// Answers a case, that of a ray, a slab or a scene, or each of an array of cases, on all cores. Every warning is told
/// to `warn` before anything is answered, and stands in the answer of its case. Throws InputError.
nlohmann::ordered_json evaluate_document(const JsonReader& document, const EvaluateRequest& request,
                                         const std::function<void(const std::string&)>& warn);

}  // namespace raytruth
