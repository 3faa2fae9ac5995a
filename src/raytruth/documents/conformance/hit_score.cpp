#include "raytruth/documents/conformance/hit_score.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/conformance/answer_lines.hpp"
#include "raytruth/documents/conformance/hit_vectors.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/statistics/statistics.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr double unit_roundoff = 0x1p-53;
constexpr std::array<std::string_view, 4> header{"id", "hit", "t", "surface"};

/// Length of the longest sequence of surfaces that both have in this order.
std::int64_t common_surfaces(const std::vector<ScoredHits::Hit>& truth, const std::vector<AnsweredHit>& answer) {
  std::vector<std::int64_t> before(answer.size() + 1);
  for (const ScoredHits::Hit& hit : truth) {
    std::vector<std::int64_t> here(answer.size() + 1);
    for (std::size_t i = 0; i < answer.size(); ++i)
      here[i + 1] = hit.surface == answer[i].surface ? before[i] + 1 : std::max(before[i + 1], here[i]);
    before = std::move(here);
  }
  return before.back();
}

Json number_json(std::optional<double> x) { return x && std::isfinite(*x) ? Json(*x) : Json(); }

Json level_json(std::string_view level, const std::vector<const ScoredHits*>& vectors) {
  std::int64_t answered = 0;
  std::int64_t right = 0;
  std::int64_t missed = 0;
  std::int64_t false_hits = 0;
  std::vector<double> digits;
  std::optional<double> error;
  std::string worst;
  double fewest = HUGE_VAL;
  for (const ScoredHits* vector : vectors) {
    if (!vector->answer) continue;
    const HitScore score = score_of(*vector);
    ++answered;
    right += score.is_right ? 1 : 0;
    missed += score.missed;
    false_hits += score.false_hits;
    if (score.digits) digits.push_back(*score.digits);
    if (score.error) error = std::max(error.value_or(0), *score.error);
    if (const double here = score.digits.value_or(-1); here < fewest) {
      fewest = here;
      worst = vector->id;
    }
  }
  std::sort(digits.begin(), digits.end());
  return {{"level", level},
          {"cases", vectors.size()},
          {"answered", answered},
          {"right", right},
          {"missed", missed},
          {"false_hits", false_hits},
          {"digits_min", digits.empty() ? Json() : Json(digits.front())},
          {"digits_median", digits.empty() ? Json() : Json(quantile(digits, 0.5))},
          {"error_max", number_json(error)},
          {"worst", worst.empty() ? Json() : Json(worst)}};
}

}  // namespace

HitScore score_of(const ScoredHits& vector) {
  const std::vector<AnsweredHit>& answer = vector.answer.value();
  const std::int64_t common = common_surfaces(vector.truth, answer);
  HitScore score{.missed = std::ssize(vector.truth) - common, .false_hits = std::ssize(answer) - common};
  score.is_right = score.missed == 0 && score.false_hits == 0;
  if (!score.is_right) return score;
  double error = 0;
  double least = unit_roundoff;
  for (std::size_t i = 0; i < answer.size(); ++i) {
    const double off = std::abs(answer[i].t - vector.truth[i].t);
    error = std::isfinite(off) ? std::max(error, off) : HUGE_VAL;
    least = std::max(least, vector.truth[i].radius / vector.length);
    if (!std::isfinite(error)) break;
  }
  score.error = error / vector.length;
  score.digits = std::isfinite(error) ? std::max(0.0, -std::log10(std::max(*score.error, least))) : 0;
  return score;
}

std::vector<ScoredHits> read_scored_hits(const JsonReader& document) {
  document.at("raytruth").word({hit_vector_form});
  document.only({"raytruth", "seed", "levels", "vectors"});
  std::vector<ScoredHits> vectors;
  std::set<std::string> ids;
  for (const JsonReader& item : document.at("vectors").items()) {
    item.only({"id", "level", "signal", "ray", "isosurfaces", "hits"});
    const auto breaks = item.at("signal").at("breaks").numbers();
    ScoredHits vector{
        .id = item.at("id").text(), .level = item.at("level").text(), .length = breaks.back(), .truth = {}};
    if (!(vector.length > 0)) item.at("signal").at("breaks").refuse_value("ascending numbers from 0");
    for (const JsonReader& hit : item.at("hits").items(0)) {
      hit.only({"t", "radius", "surface", "rising"});
      vector.truth.push_back(
          {hit.at("t").number(), hit.at("radius").number(0), hit.at("surface").integer(0, 1'000'000)});
    }
    if (!ids.insert(vector.id).second) item.at("id").refuse_value("each id once");
    vectors.push_back(std::move(vector));
  }
  return vectors;
}

std::map<std::string, std::vector<AnsweredHit>> read_hit_answers(const std::string& path,
                                                                 std::vector<std::string>& warnings) {
  return hit_answers_in(read_text(path, "a readable CSV file"), input_name(path), warnings);
}

std::map<std::string, std::vector<AnsweredHit>> hit_answers_in(std::string_view text, const std::string& name,
                                                               std::vector<std::string>& warnings) {
  AnswerLines read(text, name, {header.begin(), header.end()});
  std::map<std::string, std::vector<AnsweredHit>> answers;
  std::set<std::string> without_hits;
  for (const AnswerLines::Line& line : read.lines()) {
    const auto fields = read.fields(line);
    auto& hits = answers[fields[0]];
    const bool is_empty = fields[1].empty() && fields[2].empty() && fields[3].empty();
    if (!without_hits.empty() && without_hits.count(fields[0]) > 0)
      line.refuse(fmt::format("a second line for '{}', which has no hits", shortened(fields[0])), "one line");
    if (is_empty) {
      if (!hits.empty()) line.refuse(fmt::format("no hit of '{}' behind hits", shortened(fields[0])), "either");
      without_hits.insert(fields[0]);
      continue;
    }
    const double count = read.number(line, header[1], fields[1]);
    if (count != static_cast<double>(hits.size()))
      line.refuse(fmt::format("hit '{}' of '{}'", shortened(fields[1]), shortened(fields[0])),
                  fmt::format("hit {}, the hits of a ray in order from 0,", hits.size()));
    const double t = read.number(line, header[2], fields[2]);
    const double surface = read.number(line, header[3], fields[3]);
    constexpr double most = 1'000'000;
    if (!(surface >= 0 && surface <= most) || surface != std::floor(surface))
      line.refuse(fmt::format("surface '{}'", shortened(fields[3])), "its place in isosurfaces, from 0,");
    hits.push_back({t, static_cast<std::int64_t>(surface)});
  }
  read.warn_of_dialect(warnings);
  return answers;
}

void take_hit_answers(std::vector<ScoredHits>& vectors, std::map<std::string, std::vector<AnsweredHit>> answers,
                      const std::string& answers_name, const std::string& vectors_name) {
  for (ScoredHits& vector : vectors)
    if (auto answer = answers.extract(vector.id)) vector.answer = std::move(answer.mapped());
  if (answers.empty()) return;
  throw InputError(fmt::format("{}: found the id '{}'; ids of {} are allowed", answers_name,
                               shortened(answers.begin()->first), vectors_name));
}

Json hit_levels_json(const std::vector<ScoredHits>& vectors) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<const ScoredHits*>> by_level;
  std::vector<const ScoredHits*> all;
  for (const ScoredHits& vector : vectors) {
    auto& level = by_level[vector.level];
    if (level.empty()) names.push_back(vector.level);
    level.push_back(&vector);
    all.push_back(&vector);
  }
  Json list = Json::array();
  for (const std::string& name : names) list.push_back(level_json(name, by_level[name]));
  list.push_back(level_json("all", all));
  return list;
}

Json scored_hits_json(const std::vector<ScoredHits>& vectors) {
  Json list = Json::array();
  for (const ScoredHits& vector : vectors) {
    std::optional<HitScore> score;
    if (vector.answer) score = score_of(vector);
    list.push_back({{"id", vector.id},
                    {"level", vector.level},
                    {"answered", score.has_value()},
                    {"hits", vector.truth.size()},
                    {"right", score ? Json(score->is_right) : Json()},
                    {"missed", score ? Json(score->missed) : Json()},
                    {"false_hits", score ? Json(score->false_hits) : Json()},
                    {"digits", score ? number_json(score->digits) : Json()},
                    {"error", score ? number_json(score->error) : Json()}});
  }
  return list;
}

}  // namespace raytruth
