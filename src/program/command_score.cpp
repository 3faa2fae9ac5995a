#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/reference/certified.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace raytruth {

namespace {

struct ScoreOptions {
  std::string vectors;
  std::string answers;
  bool json = false;
};

using Json = nlohmann::ordered_json;

Certified read_truth(const JsonReader& json) {
  json.only({"color", "opacity", "error_bound"});
  const auto color = json.at("color").numbers(3);
  if (color.size() != 3) json.at("color").refuse_value("a list of 3 numbers");
  return {{.color = {color[0], color[1], color[2]}, .opacity = json.at("opacity").number()},
          json.at("error_bound").number(0)};
}

/// What a score needs of the vectors: their answers are still to come.
std::vector<ScoredVector> read_vectors(const std::string& path) {
  const JsonReader document = JsonReader::from_file(path);
  document.at("raytruth").word({"vectors/1"});
  document.only({"raytruth", "seed", "levels", "vectors"});
  std::vector<ScoredVector> vectors;
  std::set<std::string> ids;
  for (const JsonReader& vector : document.at("vectors").items()) {
    vector.only({"id", "level", "emission", "signal", "slab", "transfer_function", "reference"});
    vectors.push_back(
        {vector.at("id").text(), vector.at("level").text(), read_truth(vector.at("reference")), std::nullopt});
    if (!ids.insert(vectors.back().id).second) vector.at("id").refuse_value("each id once");
  }
  return vectors;
}

/// Gives the vectors their answers.
void take_answers(std::vector<ScoredVector>& vectors, const ScoreOptions& options) {
  std::vector<std::string> warnings;
  auto answers = read_answers(options.answers, warnings);
  for (const std::string& warning : warnings) say(warning);
  std::vector<std::string> missing;
  for (ScoredVector& vector : vectors) {
    const auto answer = answers.extract(vector.id);
    if (answer)
      vector.answer = answer.mapped();
    else
      missing.push_back(vector.id);
  }
  const std::string name = input_name(options.answers);
  if (!answers.empty()) {
    std::vector<std::string> ids;
    for (const ScoredVector& vector : vectors) ids.push_back(vector.id);
    const std::string& unknown = answers.begin()->first;
    const auto closest = closest_word(unknown, ids);
    throw InputError(fmt::format("{}: found the id '{}'{}; ids of {} are allowed", name, shortened(unknown),
                                 closest.empty() ? "" : fmt::format(" (perhaps {})", closest),
                                 input_name(options.vectors)));
  }
  if (!missing.empty())
    say(fmt::format("{}: no answer for {} of {} vectors, which count as no digits; the first is {}", name,
                    missing.size(), vectors.size(), missing.front()));
}

Json scores_json(const std::vector<LevelScore>& scores) {
  Json list = Json::array();
  for (const LevelScore& score : scores)
    list.push_back({{"level", score.level},
                    {"cases", score.cases},
                    {"answered", score.answered},
                    {"digits_min", score.digits_min},
                    {"digits_median", score.digits_median},
                    {"worst", score.worst}});
  return list;
}

std::string scores_text(const std::vector<LevelScore>& scores) {
  std::size_t width = 0;
  for (const LevelScore& score : scores) width = std::max(width, score.level.size());
  std::string text = fmt::format("{:<{}}  cases  answered  digits: least  median  worst case\n", "level", width);
  for (const LevelScore& score : scores)
    text += fmt::format("{:<{}}  {:5}  {:8}  {:13.2f}  {:6.2f}  {}\n", score.level, width, score.cases, score.answered,
                        score.digits_min, score.digits_median, score.worst);
  return text;
}

int score_answers(const ScoreOptions& options) {
  std::vector<ScoredVector> vectors = read_vectors(options.vectors);
  take_answers(vectors, options);
  const auto scores = score(vectors);
  print(options.json ? scores_json(scores).dump(2) + "\n" : scores_text(scores));
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<ScoreOptions>();
  add.operand("vectors", options->vectors, "JSON file, written by `raytruth vectors`");
  add.operand("answers", options->answers, "CSV file with the header id,r,g,b,opacity; '-' is standard input");
  add.flag("--json", options->json, "As JSON");
  return [options] { return score_answers(*options); };
}

}  // namespace

extern const Command score_command;
const Command score_command{
    .name = "score",
    .summary = "Count the digits that are right in a program's answers to the vectors",
    .example = "raytruth score vectors.json answers.csv",
    .notes =
        "Digits of an answer: -log10(error / scale), of colour and opacity the lesser one. The colour's\n"
        "error is that of its worst channel, its scale the largest channel of the certified colour; the\n"
        "opacity's scale is the certified opacity. Errors below the certified error_bound, or 2^-53 of the\n"
        "scale, count as that much; errors above the scale have no digits, nor has a vector without an\n"
        "answer, or whose answer is not finite. Ids that are not in the vectors are refused. Semicolons between\n"
        "fields, and decimal commas with them, are read as spreadsheets write them.",
    .describe = describe};

}  // namespace raytruth
