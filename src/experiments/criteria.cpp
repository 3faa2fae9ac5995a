#include "experiments/criteria.hpp"

#include "experiments/texts.hpp"
#include "raytruth/documents/json/json_reader.hpp"

namespace raytruth {

namespace {

std::optional<double> limit(const JsonReader& json, const char* key) {
  const auto found = json.find(key);
  return found ? std::optional(found->number()) : std::nullopt;
}

std::vector<Criterion> read_criteria() {
  std::vector<Criterion> all;
  for (const JsonReader& json : JsonReader::from_text(criteria_text, "criteria.json").at("criteria").items())
    all.push_back({.name = json.at("name").text(),
                   .sentence = json.at("sentence").text(),
                   .reason = json.at("reason").text(),
                   .at_least = limit(json, "at_least"),
                   .at_most = limit(json, "at_most")});
  return all;
}

}  // namespace

const std::vector<Criterion>& criteria() {
  static const std::vector<Criterion> all = read_criteria();
  return all;
}

}  // namespace raytruth
