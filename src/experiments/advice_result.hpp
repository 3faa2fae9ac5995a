#pragma once

#include "raytruth/documents/advice_document.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace raytruth {

/// Advice as a result (result/1) whose rows are the ways, from the cheapest to the dearest, so that `raytruth plot`
/// draws error against cost; "advice" holds the best and the next cheaper one, and how far they are to be trusted.
nlohmann::ordered_json advice_result(const AdviceDocument& asked, const Advice& advice);

/// Advice for a terminal: what to take, what the next cheaper way would cost, and a line for every way that matters.
std::string advice_text(const AdviceDocument& asked, const Advice& advice);

}  // namespace raytruth
