#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/documents/conformance/hit_score.hpp"
#include "raytruth/documents/conformance/hit_vectors.hpp"
#include "raytruth/documents/conformance/score_document.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/documents/json/json_reader.hpp"

#include <fmt/format.h>
#include <boost/algorithm/string/trim.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace raytruth {

namespace {

struct ScoreOptions {
  std::string vectors;
  std::string answers;
  std::optional<std::string> emission;  ///< only vectors of this convention; none: all
  bool per_vector = false;
  bool json = false;
};

using Json = nlohmann::ordered_json;

/// Leaves the vectors that are asked for.
void select(std::vector<ScoredVector>& vectors, const ScoreOptions& options) {
  if (!options.emission) return;
  std::erase_if(vectors, [&](const ScoredVector& vector) { return name_of(vector.emission) != *options.emission; });
  if (vectors.empty())
    throw InputError(fmt::format("--emission: {} has no vectors whose emission is {}", input_name(options.vectors),
                                 *options.emission));
}

void tell_missing(const std::vector<ScoredVector>& vectors, const ScoreOptions& options) {
  const auto is_missing = [](const ScoredVector& vector) { return !vector.answer; };
  const auto count = std::count_if(vectors.begin(), vectors.end(), is_missing);
  if (count == 0) return;
  say(fmt::format("{}: no answer for {} of {} vectors, which are left out of the digits; the first is {}",
                  input_name(options.answers), count, vectors.size(),
                  std::find_if(vectors.begin(), vectors.end(), is_missing)->id));
}

/// A column of a table: one of the members of its lines.
struct Column {
  std::string_view key;
  std::string_view head;
  enum class Kind { word, count, digits, error } kind;
};

constexpr std::array level_columns{
    Column{"level", "level", Column::Kind::word},
    Column{"cases", "cases", Column::Kind::count},
    Column{"answered", "answered", Column::Kind::count},
    Column{"digits_min", "digits: least", Column::Kind::digits},
    Column{"digits_median", "median", Column::Kind::digits},
    Column{"color_digits_min", "colour: digits", Column::Kind::digits},
    Column{"color_error_max", "error", Column::Kind::error},
    Column{"opacity_digits_min", "opacity: digits", Column::Kind::digits},
    Column{"opacity_error_max", "error", Column::Kind::error},
    Column{"worst", "worst case", Column::Kind::word},
};

constexpr std::array vector_columns{
    Column{"id", "id", Column::Kind::word},
    Column{"emission", "emission", Column::Kind::word},
    Column{"digits", "digits", Column::Kind::digits},
    Column{"color_digits", "colour: digits", Column::Kind::digits},
    Column{"color_error", "error", Column::Kind::error},
    Column{"opacity_digits", "opacity: digits", Column::Kind::digits},
    Column{"opacity_error", "error", Column::Kind::error},
};

constexpr std::array hit_level_columns{
    Column{"level", "level", Column::Kind::word},
    Column{"cases", "cases", Column::Kind::count},
    Column{"answered", "answered", Column::Kind::count},
    Column{"right", "right", Column::Kind::count},
    Column{"missed", "hits missed", Column::Kind::count},
    Column{"false_hits", "false", Column::Kind::count},
    Column{"digits_min", "digits: least", Column::Kind::digits},
    Column{"digits_median", "median", Column::Kind::digits},
    Column{"worst", "worst case", Column::Kind::word},
};

constexpr std::array hit_columns{
    Column{"id", "id", Column::Kind::word},           Column{"hits", "hits", Column::Kind::count},
    Column{"missed", "missed", Column::Kind::count},  Column{"false_hits", "false", Column::Kind::count},
    Column{"digits", "digits", Column::Kind::digits}, Column{"error", "error", Column::Kind::error},
};

std::string cell_text(const Column& column, const Json& value) {
  if (value.is_null()) return "-";
  switch (column.kind) {
    case Column::Kind::word:
      return value.get<std::string>();
    case Column::Kind::count:
      return fmt::format("{}", value.get<std::int64_t>());
    case Column::Kind::digits:
      return fmt::format("{:.2f}", value.get<double>());
    case Column::Kind::error:
      break;
  }
  return fmt::format("{:.1e}", value.get<double>());
}

/// The lines as a table: words to the left, numbers to the right.
std::string table_text(std::span<const Column> columns, const Json& lines) {
  std::vector<std::vector<std::string>> table{{}};
  for (const Column& column : columns) table.front().emplace_back(column.head);
  for (const Json& line : lines) {
    auto& cells = table.emplace_back();
    for (const Column& column : columns) cells.push_back(cell_text(column, line.at(column.key)));
  }
  std::vector<std::size_t> widths(columns.size());
  for (const auto& cells : table)
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], cells[i].size());
  std::string text;
  for (const auto& cells : table) {
    std::string row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool is_word = columns[i].kind == Column::Kind::word;
      row += i == 0 ? "" : "  ";
      row += is_word ? fmt::format("{:<{}}", cells[i], widths[i]) : fmt::format("{:>{}}", cells[i], widths[i]);
    }
    text += boost::trim_right_copy(row) + "\n";
  }
  return text;
}

void print_lines(const Json& lines, std::span<const Column> columns, bool as_json) {
  print(as_json ? lines.dump(2) + "\n" : table_text(columns, lines));
}

int score_hits(const JsonReader& document, const ScoreOptions& options) {
  if (options.emission)
    throw InputError("command line: --emission: found it with vectors of hits, which have none; no such option");
  std::vector<ScoredHits> vectors = read_scored_hits(document);
  std::vector<std::string> warnings;
  auto answers = read_hit_answers(options.answers, warnings);
  for (const std::string& warning : warnings) say(warning);
  take_hit_answers(vectors, std::move(answers), input_name(options.answers), input_name(options.vectors));
  if (options.per_vector)
    print_lines(scored_hits_json(vectors), hit_columns, options.json);
  else
    print_lines(hit_levels_json(vectors), hit_level_columns, options.json);
  return 0;
}

int score_answers(const ScoreOptions& options) {
  const JsonReader document = JsonReader::from_file(options.vectors);
  if (document.at("raytruth").json() == Json(hit_vector_form)) return score_hits(document, options);
  std::vector<ScoredVector> vectors = read_scored_vectors(document);
  std::vector<std::string> warnings;
  auto answers = read_answers(options.answers, warnings);
  for (const std::string& warning : warnings) say(warning);
  take_answers(vectors, std::move(answers), input_name(options.answers), input_name(options.vectors));
  select(vectors, options);
  tell_missing(vectors, options);
  const Json lines = options.per_vector ? scored_json(vectors) : levels_json(score(vectors));
  const std::span<const Column> columns =
      options.per_vector ? std::span<const Column>(vector_columns) : std::span<const Column>(level_columns);
  print_lines(lines, columns, options.json);
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<ScoreOptions>();
  add.operand("vectors", options->vectors, "JSON file, written by `raytruth vectors`");
  add.operand("answers", options->answers,
              "CSV file with the header id,r,g,b,opacity, or id,hit,t,surface; '-' is standard input");
  add.word("--emission", options->emission, {"associated", "plain"},
           "Score the vectors of this convention only (default: all)");
  add.flag("--per-vector", options->per_vector, "A line for each vector, not for each level");
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
        "Digits of an answer: -log10(error / scale), of colour and opacity the lesser one; both stand by\n"
        "themselves beside it, with their absolute errors. The colour's error is that of its worst channel,\n"
        "its scale the largest channel of the certified colour; the opacity's scale is the certified\n"
        "opacity. Errors below the certified error_bound, or 2^-53 of the scale, count as that much; errors\n"
        "above the scale have no digits, nor has an answer that is not finite.\n"
        "\n"
        "A level is counted over what was answered: vectors without an answer are left out of its digits,\n"
        "and how many were answered stands beside them. A program that knows one convention of emission\n"
        "says which: --emission associated, or plain. Ids that are not in the vectors are refused.\n"
        "Vectors of the forms vectors/1 and vectors/2 are read; semicolons between fields, and decimal\n"
        "commas with them, are read as spreadsheets write them.\n"
        "\n"
        "Of `raytruth vectors --hits` an answer is CSV id,hit,t,surface: a line for each hit of a ray, counted\n"
        "from 0, front to back, or its id alone where there is none. A ray is right where the number of its\n"
        "hits and the order of their surfaces are; then it has digits, -log10 of the worst error of t over\n"
        "the ray's length.",
    .describe = describe};

}  // namespace raytruth
