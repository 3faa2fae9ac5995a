#include "raytruth/documents/conformance/score_document.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/case_json.hpp"
#include "raytruth/documents/conformance/vectors.hpp"
#include "raytruth/reference/certified.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>
#include <optional>
#include <set>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

Certified read_truth(const JsonReader& json) {
  json.only({"color", "opacity", "error_bound"});
  const auto color = json.at("color").numbers(3);
  if (color.size() != 3) json.at("color").refuse_value("a list of 3 numbers");
  return {{.color = {color[0], color[1], color[2]}, .opacity = json.at("opacity").number()},
          json.at("error_bound").number(0)};
}

/// A number, or null where there is none: no answer, or one that is not finite.
Json number_json(std::optional<double> x) { return x && std::isfinite(*x) ? Json(*x) : Json(); }

}  // namespace

std::vector<ScoredVector> read_scored_vectors(const JsonReader& document) {
  document.at("raytruth").word({vector_form_names.begin(), vector_form_names.end()});
  document.only({"raytruth", "seed", "levels", "vectors"});
  std::vector<ScoredVector> vectors;
  std::set<std::string> ids;
  for (const JsonReader& vector : document.at("vectors").items()) {
    vector.only({"id", "level", "emission", "signal", "slab", "transfer_function", "separate_lists", "reference"});
    vectors.push_back({vector.at("id").text(), vector.at("level").text(), read_truth(vector.at("reference")),
                       std::nullopt, read_emission(vector)});
    if (!ids.insert(vectors.back().id).second) vector.at("id").refuse_value("each id once");
  }
  return vectors;
}

void take_answers(std::vector<ScoredVector>& vectors, std::map<std::string, Answer> answers,
                  const std::string& answers_name, const std::string& vectors_name) {
  for (ScoredVector& vector : vectors)
    if (const auto answer = answers.extract(vector.id)) vector.answer = answer.mapped();
  if (answers.empty()) return;
  std::vector<std::string> ids;
  for (const ScoredVector& vector : vectors) ids.push_back(vector.id);
  const std::string& unknown = answers.begin()->first;
  const auto closest = closest_word(unknown, ids);
  throw InputError(fmt::format("{}: found the id '{}'{}; ids of {} are allowed", answers_name, shortened(unknown),
                               closest.empty() ? "" : fmt::format(" (perhaps {})", closest), vectors_name));
}

std::string_view name_of(Emission emission) { return emission == Emission::associated ? "associated" : "plain"; }

Json levels_json(const std::vector<LevelScore>& scores) {
  Json list = Json::array();
  for (const LevelScore& score : scores)
    list.push_back({{"level", score.level},
                    {"cases", score.cases},
                    {"answered", score.answered},
                    {"digits_min", number_json(score.digits_min)},
                    {"digits_median", number_json(score.digits_median)},
                    {"worst", score.worst ? Json(*score.worst) : Json()},
                    {"not_finite", score.not_finite},
                    {"color_digits_min", number_json(score.color.digits_min)},
                    {"color_digits_median", number_json(score.color.digits_median)},
                    {"color_error_max", number_json(score.color.error_max)},
                    {"opacity_digits_min", number_json(score.opacity.digits_min)},
                    {"opacity_digits_median", number_json(score.opacity.digits_median)},
                    {"opacity_error_max", number_json(score.opacity.error_max)}});
  return list;
}

Json scored_json(const std::vector<ScoredVector>& vectors) {
  Json list = Json::array();
  for (const ScoredVector& vector : vectors) {
    std::optional<AnswerScore> score;
    if (vector.answer) score = score_of(*vector.answer, vector.truth);
    const auto number = [&score](auto member) { return score ? number_json(std::invoke(member, *score)) : Json(); };
    list.push_back({{"id", vector.id},
                    {"level", vector.level},
                    {"emission", name_of(vector.emission)},
                    {"answered", vector.answer.has_value()},
                    {"digits", number(&AnswerScore::digits)},
                    {"color_digits", number(&AnswerScore::color_digits)},
                    {"color_error", number(&AnswerScore::color_error)},
                    {"opacity_digits", number(&AnswerScore::opacity_digits)},
                    {"opacity_error", number(&AnswerScore::opacity_error)},
                    {"error_bound", vector.truth.radius}});
  }
  return list;
}

}  // namespace raytruth
