#include "experiments/ledger.hpp"

#include "experiments/result.hpp"
#include "experiments/texts.hpp"
#include "experiments/verdict.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
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
      {"kind",
       "claim; finding: what no publication says but a reader should know; internal consistency: printed numbers "
       "against each other"},
      {"claim_verdict",
       "of the claim as a whole: its parts' verdict, leaving out what is not comparable; mixed where they differ, "
       "compatible where they are reproduced and compatible"},
      {"paper", "the publication"},
      {"place", "where it states this"},
      {"text", "what it says"},
      {"stated", "the figure or the sentence that is judged"},
      {"reading", "how the sentence is read"},
      {"method", "whose or which method is judged, where several are called so"},
      {"baseline", "what it is compared with"},
      {"subject", "on what: volumes, rays, views, parameters"},
      {"criterion", "what decides: a row of the table of criteria in experiments/README.md"},
      {"deviation", "where the criterion is departed from, and why"},
      {"measured", "what was measured instead"},
      {"unit", "of measured, low and high"},
      {"column", "the column of the experiment's rows that measured is of"},
      {"low", "lower end of what was measured"},
      {"high", "its upper end"},
      {"range", "what low and high are: two columns, a radius, or the extremes of so many rows"},
      {"percentile", "how much of what was measured lies below the printed figure, from 0 to 1"},
      {"verdict",
       "of this part: reproduced, compatible, contradicted, not comparable or not measured; found or not found; "
       "consistent or inconsistent"},
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
          {"kind", member("kind").is_null() ? Json(statement_kinds.front()) : member("kind")},
          {"claim_verdict", nullptr},
          {"paper", member("paper")},
          {"place", member("place")},
          {"text", member("text")},
          {"stated", as_cell(claim.at("stated"))},
          {"reading", member("reading")},
          {"method", member("method")},
          {"baseline", member("baseline")},
          {"subject", member("subject")},
          {"criterion", member("criterion")},
          {"deviation", member("deviation")},
          {"measured", nullptr},
          {"unit", nullptr},
          {"column", nullptr},
          {"low", nullptr},
          {"high", nullptr},
          {"range", nullptr},
          {"percentile", nullptr},
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

/// The verdict on a claim of several parts.
std::string joint_verdict(const std::set<std::string>& verdicts) {
  std::set<std::string> judged = verdicts;
  judged.erase("not comparable");
  judged.erase("not measured");
  if (judged.empty()) return verdicts.contains("not comparable") ? "not comparable" : "not measured";
  if (judged.size() == 1) return *judged.begin();
  return judged == std::set<std::string>{"compatible", "reproduced"} ? "compatible" : "mixed";
}

/// Gives each row the verdict on its whole claim; findings are none.
void add_joint_verdicts(Json& rows) {
  std::map<std::string, std::set<std::string>> verdicts;
  const auto is_finding = [](const Json& row) {
    return row.at("kind") == statement_kinds[static_cast<std::size_t>(StatementKind::finding)];
  };
  for (const Json& row : rows)
    if (!is_finding(row)) verdicts[row.at("claim")].insert(row.at("verdict").get<std::string>());
  for (Json& row : rows)
    if (!is_finding(row)) row["claim_verdict"] = joint_verdict(verdicts.at(row.at("claim")));
}

/// The rows of a claim: what experiments found of it, or that none judges it. Findings alone judge nothing.
void add_rows(const Json& claim, const std::vector<Judged>& verdicts, Json& rows) {
  const bool is_judged = std::any_of(verdicts.begin(), verdicts.end(), [](const Judged& verdict) {
    return verdict.claim.value("kind", "") != statement_kinds[static_cast<std::size_t>(StatementKind::finding)];
  });
  const bool is_claim =
      !claim.contains("kind") || claim.at("kind") != statement_kinds[static_cast<std::size_t>(StatementKind::finding)];
  if (!is_judged && is_claim) rows.push_back(empty_row(claim));
  for (const Judged& verdict : verdicts) rows.push_back(judged_row(claim, verdict));
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
  for (const Json& claim : claims) add_rows(claim, judged.at(claim.at("claim")), rows);
  for (const std::string& name : unknown)
    for (const Judged& verdict : judged.at(name)) rows.push_back(judged_row(verdict.claim, verdict));

  add_joint_verdicts(rows);

  const Provenance provenance{.profile = "full",
                              .times = RunTimes{.threads = 1, .started = utc_text(std::chrono::system_clock::now())}};
  return {{"raytruth", "result/1"},
          {"experiment",
           {{"raytruth", "experiment/1"}, {"name", "ledger"}, {"question", "Which of the publications' claims hold?"}}},
          {"provenance", to_json(provenance)},
          {"styles", Json::object()},
          {"fields", Json::object()},
          {"columns", columns()},
          {"criteria", Json::parse(criteria_text).at("criteria")},
          {"rows", std::move(rows)},
          {"published", Json::array()},
          {"checks", Json::array()}};
}

}  // namespace raytruth
