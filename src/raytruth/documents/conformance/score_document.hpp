#pragma once

#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/documents/json/json_reader.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// The vectors of a document that `raytruth vectors` wrote, of any form, without answers. Throws InputError.
std::vector<ScoredVector> read_scored_vectors(const JsonReader& document);

/// Gives the vectors their answers, by their ids. Throws InputError for an id that none of them has; `answers_name` and
/// `vectors_name` are what the message calls them.
void take_answers(std::vector<ScoredVector>& vectors, std::map<std::string, Answer> answers,
                  const std::string& answers_name, const std::string& vectors_name);

/// How a convention of emission is called: "associated" or "plain".
std::string_view name_of(Emission emission);

/// A row for each level, and for each vector. Where there is no answer, or none that is finite, numbers are null.
nlohmann::ordered_json levels_json(const std::vector<LevelScore>& scores);
nlohmann::ordered_json scored_json(const std::vector<ScoredVector>& vectors);

}  // namespace raytruth
