#pragma once

#include "raytruth/documents/case.hpp"
#include "raytruth/documents/conformance/vectors.hpp"
#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/documents/outside_program.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// A program's answers, by the vectors' ids.
struct OutsideAnswers {
  std::map<std::string, Answer> answers;
  std::optional<std::string> version = {};
};

/// Asks a program for colours and opacities. It reads the vectors as experiments/schemas/vectors.json describes them,
/// without their references; beside each stand `samples`, the scalars at the ends of `intervals` equal intervals along
/// a ray, of one along a slab. It writes CSV, as `score` reads it, and may leave vectors out. Throws OutsideRefusal.
OutsideAnswers outside_answers(const OutsideProgram& program, const std::vector<ConformanceVector>& vectors,
                               std::int64_t intervals);

/// Adds to what `eval` answers of a ray what its programs answer, or why they do not.
void add_outside_answers(const Case& ray, bool runs_programs, nlohmann::ordered_json& answer);

}  // namespace raytruth
