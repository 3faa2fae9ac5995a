#include "raytruth/documents/conformance/vectors_score.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/conformance/answer_lines.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string_view>

namespace raytruth {

namespace {

constexpr double unit_roundoff = 0x1p-53;
constexpr std::array<std::string_view, 5> header{"id", "r", "g", "b", "opacity"};

bool is_finite(const Answer& answer) { return answer.color.isFinite().all() && std::isfinite(answer.opacity); }

double digits_of(double error, double scale, double radius) {
  if (!std::isfinite(error)) return 0;
  if (!(scale > 0)) return error <= radius ? -std::log10(unit_roundoff) : 0;
  return std::max(0.0, -std::log10(std::max({error, radius, unit_roundoff * scale}) / scale));
}

/// What the answers come to in one respect: which digits of an AnswerScore, and which error.
template <class Digits, class Error>
PartScore score_part(const std::vector<AnswerScore>& answers, Digits digits_of_answer, Error error_of_answer) {
  PartScore part;
  std::vector<double> digits;
  for (const AnswerScore& answer : answers) {
    digits.push_back(std::invoke(digits_of_answer, answer));
    const double error = std::invoke(error_of_answer, answer);
    if (std::isfinite(error)) part.error_max = std::max(part.error_max.value_or(0), error);
  }
  if (digits.empty()) return part;
  std::sort(digits.begin(), digits.end());
  part.digits_min = digits.front();
  part.digits_median = quantile(digits, 0.5);
  return part;
}

LevelScore score_level(std::string level, const std::vector<const ScoredVector*>& vectors) {
  LevelScore result;
  result.level = std::move(level);
  result.cases = static_cast<std::int64_t>(vectors.size());
  std::vector<AnswerScore> answers;
  std::vector<double> errors;
  double fewest = std::numeric_limits<double>::infinity();
  for (const ScoredVector* vector : vectors) {
    if (!vector->answer) continue;
    if (!is_finite(*vector->answer)) ++result.not_finite;
    answers.push_back(score_of(*vector->answer, vector->truth));
    if (const double error = answers.back().error(); std::isfinite(error)) errors.push_back(error);
    if (const double digits = answers.back().digits(); digits < fewest) {
      fewest = digits;
      result.worst = vector->id;
    }
  }
  result.answered = static_cast<std::int64_t>(answers.size());
  if (!errors.empty())
    result.error_mean = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  result.color = score_part(answers, &AnswerScore::color_digits, &AnswerScore::color_error);
  result.opacity = score_part(answers, &AnswerScore::opacity_digits, &AnswerScore::opacity_error);
  const PartScore both = score_part(answers, &AnswerScore::digits, &AnswerScore::error);
  result.digits_min = both.digits_min;
  result.digits_median = both.digits_median;
  return result;
}

}  // namespace

AnswerScore score_of(const Answer& answer, const Certified& truth) {
  AnswerScore score{.color_error = answer.color.isFinite().all() ? (answer.color - truth.color).abs().maxCoeff()
                                                                 : std::numeric_limits<double>::infinity(),
                    .opacity_error = std::isfinite(answer.opacity) ? std::abs(answer.opacity - truth.opacity)
                                                                   : std::numeric_limits<double>::infinity()};
  score.color_digits = digits_of(score.color_error, truth.color.maxCoeff(), truth.radius);
  score.opacity_digits = digits_of(score.opacity_error, truth.opacity, truth.radius);
  return score;
}

std::vector<LevelScore> score(const std::vector<ScoredVector>& vectors) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<const ScoredVector*>> by_level;
  std::vector<const ScoredVector*> all;
  for (const ScoredVector& vector : vectors) {
    auto& level = by_level[vector.level];
    if (level.empty()) names.push_back(vector.level);
    level.push_back(&vector);
    all.push_back(&vector);
  }
  std::vector<LevelScore> scores;
  for (const std::string& name : names) scores.push_back(score_level(name, by_level[name]));
  scores.push_back(score_level("all", all));
  return scores;
}

std::map<std::string, Answer> read_answers(const std::string& path, std::vector<std::string>& warnings) {
  return answers_in(read_text(path, "a readable CSV file"), input_name(path), warnings);
}

std::map<std::string, Answer> answers_in(std::string_view text, const std::string& name,
                                         std::vector<std::string>& warnings) {
  AnswerLines read(text, name, {header.begin(), header.end()});
  std::map<std::string, Answer> answers;
  std::vector<std::string> without_numbers;
  for (const AnswerLines::Line& line : read.lines()) {
    const auto fields = read.fields(line);
    std::array<double, 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = read.number(line, header[i + 1], fields[i + 1]);
    const Answer answer{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
    if (!answers.emplace(fields[0], answer).second)
      line.refuse(fmt::format("a second answer for '{}'", shortened(fields[0])), "one answer for each id");
    if (!is_finite(answer)) without_numbers.push_back(fields[0]);
  }
  read.warn_of_dialect(warnings);
  if (!without_numbers.empty())
    warnings.push_back(fmt::format("{}: {} of {} answers are not finite, and count as no digits; the first is {}", name,
                                   without_numbers.size(), answers.size(), shortened(without_numbers.front())));
  return answers;
}

}  // namespace raytruth
