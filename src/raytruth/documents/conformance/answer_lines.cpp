#include "raytruth/documents/conformance/answer_lines.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/algorithm/string/trim.hpp>
#include <boost/tokenizer.hpp>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <system_error>
#include <utility>

namespace raytruth {

void AnswerLines::Line::refuse(std::string_view found, std::string_view allowed) const {
  throw InputError(one_line(fmt::format("{}: found {}; {} is allowed", place, found, allowed)));
}

AnswerLines::AnswerLines(std::string_view text, std::string name, std::vector<std::string_view> header)
    : name_(std::move(name)), header_(std::move(header)) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(fmt::format("{}: found text in UTF-16, by its byte order mark; UTF-8 is allowed", name_));
  std::istringstream stream{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
    if (!boost::trim_copy(line).empty()) lines_.push_back({fmt::format("{}: line {}", name_, number), line});
  if (lines_.empty())
    throw InputError(fmt::format("{}: found no lines; a header {} is allowed", name_, fmt::join(header_, ",")));
  const Line first = lines_.front();
  // By the header: a semicolon or a tabulator stands there only where it separates.
  for (const char separator : {';', '\t'})
    if (separator_ == ',' && first.text.find(separator) != std::string::npos) separator_ = separator;
  const auto found = split(first);
  if (!std::equal(header_.begin(), header_.end(), found.begin()))
    first.refuse(fmt::format("'{}'", shortened(boost::trim_copy(first.text))),
                 fmt::format("the header {}", fmt::join(header_, ",")));
  lines_.erase(lines_.begin());
}

std::vector<std::string> AnswerLines::fields(const Line& line) const {
  auto fields = split(line);
  if (fields.front().empty()) line.refuse("no id", "the id of a vector");
  return fields;
}

std::vector<std::string> AnswerLines::split(const Line& line) const {
  std::vector<std::string> fields;
  try {
    // A backslash means nothing in RFC 4180; the escape character is one that no id and no number has.
    const boost::tokenizer tokens(line.text, boost::escaped_list_separator<char>('\x1b', separator_, '"'));
    for (const std::string& token : tokens) fields.push_back(boost::trim_copy(token));
  } catch (const boost::escaped_list_error&) {
    line.refuse("an escape character", "text");
  }
  if (fields.size() == header_.size()) return fields;
  const std::size_t with_decimal_commas = 1 + 2 * (header_.size() - 1);
  const bool has_decimal_commas =
      separator_ == ',' && fields.size() > header_.size() && fields.size() <= with_decimal_commas;
  line.refuse(fmt::format("{} fields", fields.size()),
              fmt::format("{}{}", fmt::join(header_, ","),
                          has_decimal_commas ? " (with decimal commas, semicolons between fields)" : ""));
}

double AnswerLines::number(const Line& line, std::string_view field_name, const std::string& field) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::string digits = field.front() == '+' ? field.substr(1) : field;
  if (separator_ != ',' && digits.find('.') == std::string::npos &&
      std::count(digits.begin(), digits.end(), ',') == 1) {
    digits[digits.find(',')] = '.';
    has_decimal_commas_ = true;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
    const bool has_comma = separator_ == ',' && field.find(',') != std::string::npos;
    line.refuse(fmt::format("{} '{}'", field_name, shortened(field)),
                has_comma ? "a number (with decimal commas, semicolons between fields)" : "a number");
  }
  // What is too small for binary64 is 0, and what is too large an infinity, as strtod has it.
  return error == std::errc::result_out_of_range ? std::strtod(digits.c_str(), nullptr) : value;
}

void AnswerLines::warn_of_dialect(std::vector<std::string>& warnings) const {
  if (separator_ == ',') return;
  warnings.push_back(fmt::format("{}: read with {} between fields{}", name_,
                                 separator_ == ';' ? "semicolons" : "tabulators",
                                 has_decimal_commas_ ? " and decimal commas" : ""));
}

}  // namespace raytruth
