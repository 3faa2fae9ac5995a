#pragma once

#include "raytruth/documents/json/json_reader.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace raytruth {

/// A result (result/1) whose rows are the claims in the order of claims.json: what each states and where, and what the
/// results say of it, a row for every part that they judge. A claim that none judges is `not measured`, with the reason
/// that claims.json gives. Claims that only a result knows come last.
nlohmann::ordered_json make_ledger(const std::vector<JsonReader>& results);

}  // namespace raytruth
