#include "raytruth/documents/conformance/vectors_score.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/statistics/statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/algorithm/string/trim.hpp>
#include <boost/tokenizer.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <sstream>
#include <string_view>
#include <system_error>

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

/// What spreadsheets put between fields, and in numbers.
struct Dialect {
  char separator = ',';
  bool has_decimal_commas = false;  ///< seen so far
};

/// By the header: a semicolon or a tabulator stands there only where it separates.
Dialect dialect_of(const std::string& text_of_header) {
  for (const char separator : {';', '\t'})
    if (text_of_header.find(separator) != std::string::npos) return {separator};
  return {};
}

/// A line of the answers, and where it stands.
struct Line {
  std::string place;
  std::string text;

  [[noreturn]] void refuse(std::string_view found, std::string_view allowed) const {
    throw InputError(one_line(fmt::format("{}: found {}; {} is allowed", place, found, allowed)));
  }

  [[nodiscard]] std::vector<std::string> fields(const Dialect& dialect) const {
    std::vector<std::string> fields;
    try {
      // A backslash means nothing in RFC 4180; the escape character is one that no id and no number has.
      const boost::tokenizer tokens(text, boost::escaped_list_separator<char>('\x1b', dialect.separator, '"'));
      for (const std::string& token : tokens) fields.push_back(boost::trim_copy(token));
    } catch (const boost::escaped_list_error&) {
      refuse("an escape character", "text");
    }
    if (fields.size() == header.size()) return fields;
    constexpr std::size_t with_decimal_commas = 1 + 2 * (header.size() - 1);
    const bool has_decimal_commas =
        dialect.separator == ',' && fields.size() > header.size() && fields.size() <= with_decimal_commas;
    refuse(fmt::format("{} fields", fields.size()),
           fmt::format("{}{}", fmt::join(header, ","),
                       has_decimal_commas ? " (with decimal commas, semicolons between fields)" : ""));
  }

  /// A number; NaN where the field is empty, and an infinity beyond binary64: neither has digits.
  [[nodiscard]] double number(std::string_view name, const std::string& field, Dialect& dialect) const {
    if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::string digits = field.front() == '+' ? field.substr(1) : field;
    if (dialect.separator != ',' && digits.find('.') == std::string::npos &&
        std::count(digits.begin(), digits.end(), ',') == 1) {
      digits[digits.find(',')] = '.';
      dialect.has_decimal_commas = true;
    }
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
      const bool has_comma = dialect.separator == ',' && field.find(',') != std::string::npos;
      refuse(fmt::format("{} '{}'", name, shortened(field)),
             has_comma ? "a number (with decimal commas, semicolons between fields)" : "a number");
    }
    // What is too small for binary64 is 0, and what is too large an infinity, as strtod has it.
    return error == std::errc::result_out_of_range ? std::strtod(digits.c_str(), nullptr) : value;
  }
};

/// The lines of a file's text that are not blank.
std::vector<Line> lines_of(std::string_view bytes, const std::string& name) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    throw InputError(fmt::format("{}: found text in UTF-16, by its byte order mark; UTF-8 is allowed", name));
  std::istringstream text{std::string(bytes)};
  std::vector<Line> lines;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number)
    if (!boost::trim_copy(line).empty()) lines.push_back({fmt::format("{}: line {}", name, number), line});
  if (lines.empty())
    throw InputError(fmt::format("{}: found no lines; a header {} is allowed", name, fmt::join(header, ",")));
  return lines;
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
  const std::vector<Line> lines = lines_of(text, name);
  Dialect dialect = dialect_of(lines.front().text);
  if (!std::equal(header.begin(), header.end(), lines.front().fields(dialect).begin()))
    lines.front().refuse(fmt::format("'{}'", shortened(boost::trim_copy(lines.front().text))),
                         fmt::format("the header {}", fmt::join(header, ",")));
  std::map<std::string, Answer> answers;
  std::vector<std::string> without_numbers;
  std::for_each(lines.begin() + 1, lines.end(), [&](const Line& line) {
    const auto fields = line.fields(dialect);
    if (fields[0].empty()) line.refuse("no id", "the id of a vector");
    std::array<double, 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = line.number(header[i + 1], fields[i + 1], dialect);
    const Answer answer{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
    if (!answers.emplace(fields[0], answer).second)
      line.refuse(fmt::format("a second answer for '{}'", shortened(fields[0])), "one answer for each id");
    if (!is_finite(answer)) without_numbers.push_back(fields[0]);
  });
  if (dialect.separator != ',')
    warnings.push_back(fmt::format("{}: read with {} between fields{}", name,
                                   dialect.separator == ';' ? "semicolons" : "tabulators",
                                   dialect.has_decimal_commas ? " and decimal commas" : ""));
  if (!without_numbers.empty())
    warnings.push_back(fmt::format("{}: {} of {} answers are not finite, and count as no digits; the first is {}", name,
                                   without_numbers.size(), answers.size(), shortened(without_numbers.front())));
  return answers;
}

}  // namespace raytruth
