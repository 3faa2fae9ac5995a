#pragma once

#include "study/json_reader.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace raytruth {

/// The text of claims.json: every testable claim of the five publications.
extern const char* const claims_text;

/// The text of ledger_page.py, which makes a page for people of the ledger.
extern const char* const ledger_page_script;

/// A result (result/1) whose rows are the claims in the order of claims.json: what each states and where, and what the
/// results say of it, a row for every part that they judge. A claim that none judges is `not measured`, with the reason
/// that claims.json gives. Claims that only a result knows come last.
nlohmann::ordered_json make_ledger(const std::vector<JsonReader>& results);

}  // namespace raytruth
