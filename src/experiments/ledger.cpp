#include "experiments/ledger.hpp"

#include "experiments/result.hpp"
#include "experiments/texts.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <initializer_list>
#include <map>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

/// A figure or a sentence as a cell; several figures as their JSON.
Json as_cell(const Json& stated) { return stated.is_structured() ? Json(stated.dump()) : stated; }

Json columns() {
  const std::initializer_list<std::pair<const char*, const char*>> descriptions{
      {"measure", "always ledger"},
      {"field", "none"},
      {"claim", "name of the claim"},
      {"part", "which of several figures of the claim"},
      {"paper", "the publication"},
      {"place", "where it states this"},
      {"text", "what it says"},
      {"stated", "the figure or the sentence that is judged"},
      {"measured", "what was measured instead"},
      {"low", "lower end of what was measured: its radius, or the 5th percentile of a distribution"},
      {"high", "upper end: its radius, or the 95th percentile"},
      {"verdict", "reproduced, contradicted, not comparable or not measured"},
      {"experiment", "the experiment that shows it"},
      {"status", "ok, or refused where nothing was measured"},
      {"why", "how the claim was read, or why it was not measured"}};
  Json json = Json::object();
  for (const auto& [name, description] : descriptions) json[name] = {{"unit", ""}, {"description", description}};
  json["claim"]["key"] = true;
  json["part"]["key"] = true;
  json["experiment"]["key"] = true;
  return json;
}

Json empty_row(const Json& claim) {
  const auto member = [&claim](const char* name) { return claim.contains(name) ? claim.at(name) : Json(); };
  return {{"measure", "ledger"},
          {"field", nullptr},
          {"claim", claim.at("claim")},
          {"part", nullptr},
          {"paper", member("paper")},
          {"place", member("place")},
          {"text", member("text")},
          {"stated", as_cell(claim.at("stated"))},
          {"measured", nullptr},
          {"low", nullptr},
          {"high", nullptr},
          {"verdict", "not measured"},
          {"experiment", nullptr},
          {"status", "refused"},
          {"why", claim.contains("why") ? claim.at("why") : Json("no experiment judges it yet")}};
}

/// A verdict of a result.
struct Judged {
  std::string experiment;
  Json claim;
};

Json judged_row(const Json& claim, const Judged& judged) {
  Json row = empty_row(claim);
  for (const auto& [name, value] : judged.claim.items()) row[name] = as_cell(value);
  row["experiment"] = judged.experiment;
  row["status"] = "ok";
  return row;
}

}  // namespace

Json make_ledger(const std::vector<JsonReader>& results) {
  std::map<std::string, std::vector<Judged>> judged;
  std::vector<std::string> unknown;
  const Json claims = Json::parse(claims_text).at("claims");
  for (const Json& claim : claims) judged[claim.at("claim")] = {};
  for (const JsonReader& result : results)
    for (const JsonReader& claim : result.at("published").items(0)) {
      const std::string name = claim.at("claim").text();
      if (!judged.contains(name)) unknown.push_back(name);
      judged[name].push_back({result.at("experiment").at("name").text(), claim.json()});
    }

  Json rows = Json::array();
  for (const Json& claim : claims) {
    const auto& verdicts = judged.at(claim.at("claim"));
    if (verdicts.empty()) rows.push_back(empty_row(claim));
    for (const Judged& verdict : verdicts) rows.push_back(judged_row(claim, verdict));
  }
  for (const std::string& name : unknown)
    for (const Judged& verdict : judged.at(name)) rows.push_back(judged_row(verdict.claim, verdict));

  const Provenance provenance{.profile = "full", .threads = 1, .started = std::chrono::system_clock::now()};
  return {{"raytruth", "result/1"},
          {"experiment",
           {{"raytruth", "experiment/1"}, {"name", "ledger"}, {"question", "Which of the publications' claims hold?"}}},
          {"provenance", to_json(provenance)},
          {"styles", Json::object()},
          {"fields", Json::object()},
          {"columns", columns()},
          {"rows", std::move(rows)},
          {"published", Json::array()},
          {"checks", Json::array()}};
}

}  // namespace raytruth
