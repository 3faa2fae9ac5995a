#include "experiments/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

Value read_value(const JsonReader& json) {
  if (json.is_string()) return json.text();
  if (json.is_boolean()) return json.boolean();
  if (json.is_null()) return {};
  return json.number();
}

std::string read_column(const JsonReader& json, const RowNames& names) {
  return json.word({names.columns.begin(), names.columns.end()});
}

Bound read_bound(const JsonReader& json, const RowNames& names) {
  Bound bound{.column = read_column(json.at("column"), names)};
  bound.at_least = json.find("at_least").has_value();
  if (bound.at_least && json.find("at_most")) json.refuse("at_least and at_most", "only one of them");
  bound.limit = json.at(bound.at_least ? "at_least" : "at_most").number();
  return bound;
}

bool are_equal(const Value& a, const Value& b) {
  const auto x = as_number(a);
  const auto y = as_number(b);
  return x && y ? *x == *y : a == b;
}

bool is_refused(const Row& row) { return are_equal(cell(row, "status"), Value("refused")); }

bool is_selected(const Row& row, const Selector& selector) {
  return std::all_of(selector.begin(), selector.end(), [&row](const auto& condition) {
    const auto& [column, values] = condition;
    const Value& here = cell(row, column);
    if (is_refused(row) && here == Value()) return true;
    return std::any_of(values.begin(), values.end(), [&here](const Value& value) { return are_equal(here, value); });
  });
}

std::vector<const Row*> select(const std::vector<Row>& rows, const Selector& selector) {
  std::vector<const Row*> selected;
  for (const Row& row : rows)
    if (is_selected(row, selector)) selected.push_back(&row);
  return selected;
}

/// The fields of rows, each once.
std::string fields_of(const std::vector<const Row*>& rows) {
  std::vector<std::string> names;
  for (const Row* row : rows)
    if (const auto* const name = std::get_if<std::string>(&cell(*row, "field"));
        name != nullptr && std::find(names.begin(), names.end(), *name) == names.end())
      names.push_back(*name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The rows that answer, and why it is not those asked first.
struct Answering {
  const Selector& rows;
  std::string why;
};

Answering answering(const Selector& first, const std::optional<Selector>& otherwise, const std::vector<Row>& rows) {
  const auto selected = select(rows, first);
  const bool are_all_refused =
      std::all_of(selected.begin(), selected.end(), [](const Row* row) { return is_refused(*row); });
  if (!otherwise || selected.empty() || !are_all_refused) return {first, {}};
  return {*otherwise, fmt::format("all rows of {} are refused: these are of {}", fields_of(selected),
                                  fields_of(select(rows, *otherwise)))};
}

/// What a verdict says: why it is not about the rows asked first, and what is stated.
Value joined(const std::string& why, const Value& stated) {
  if (why.empty()) return stated;
  const auto* const text = std::get_if<std::string>(&stated);
  return text == nullptr ? why : why + "; " + *text;
}

/// The reason that a refused row gives.
Value why_refused(const Row& row) { return cell(row, "why"); }

std::string why_missing(const std::string& column) { return column + " is null in a row selected"; }

Value stated_why(const Claim& claim) { return claim.why.empty() ? Value() : Value(claim.why); }

Verdict not_comparable(Value why) { return {{}, {}, {}, "not comparable", std::move(why)}; }

std::optional<double> radius_of(const std::string& column, const Row& row, const std::vector<Column>& columns) {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&column](const Column& c) { return c.name == column; });
  if (found == columns.end() || found->radius.empty()) return 0.0;
  return as_number(cell(row, found->radius));
}

Verdict judge_figure(const Claim& claim, const Selector& selector, const std::vector<Row>& rows,
                     const std::vector<Column>& columns) {
  const auto selected = select(rows, selector);
  if (selected.size() != 1)
    return not_comparable(fmt::format("{} rows are selected; a figure is compared with one", selected.size()));
  const Row& row = *selected.front();
  if (is_refused(row)) return not_comparable(why_refused(row));
  const auto measured = as_number(cell(row, claim.measured));
  if (!measured) return not_comparable(why_missing(claim.measured));
  const auto radius = radius_of(claim.measured, row, columns);
  if (!radius) return not_comparable("the radius of " + why_missing(claim.measured));
  const auto low = claim.low.empty() ? *measured - *radius : as_number(cell(row, claim.low));
  const auto high = claim.high.empty() ? *measured + *radius : as_number(cell(row, claim.high));
  if (!low || !high) return not_comparable(why_missing(low ? claim.high : claim.low));
  const double stated = std::get<double>(claim.stated);
  const bool meets = *low <= stated + claim.resolution / 2 && stated - claim.resolution / 2 <= *high;
  return {*measured, *low, *high, meets ? "reproduced" : "contradicted", stated_why(claim)};
}

/// What the rows selected say of a bound.
struct BoundFindings {
  std::vector<double> values;  ///< ascending
  Value missing;               ///< why a value is missing, if one is
};

/// Refused rows say nothing unless there are no others.
BoundFindings collect(const std::vector<Row>& rows, const Selector& selector, const std::string& column) {
  BoundFindings findings;
  const auto selected = select(rows, selector);
  if (selected.empty()) findings.missing = "no row is selected";
  for (const Row* row : selected) {
    const auto value = as_number(cell(*row, column));
    if (value)
      findings.values.push_back(*value);
    else if (!is_refused(*row))
      findings.missing = why_missing(column);
  }
  if (findings.values.empty() && findings.missing == Value()) findings.missing = why_refused(*selected.front());
  std::sort(findings.values.begin(), findings.values.end());
  return findings;
}

double worst(const BoundFindings& findings, const Bound& bound) {
  return bound.at_least ? findings.values.front() : findings.values.back();
}

bool holds(double value, const Bound& bound) { return bound.at_least ? value >= bound.limit : value <= bound.limit; }

Verdict judge_sentence(const Claim& claim, const Selector& selector, const Bound& test, const std::vector<Row>& rows) {
  const auto findings = collect(rows, selector, test.column);
  if (findings.missing != Value()) return not_comparable(findings.missing);
  const double measured = worst(findings, test);
  return {measured, findings.values.front(), findings.values.back(),
          holds(measured, test) ? "reproduced" : "contradicted", stated_why(claim)};
}

}  // namespace

Selector read_selector(const JsonReader& json, const RowNames& names) {
  Selector selector;
  for (const auto& [column, json_value] : json.members()) {
    if (std::find(names.columns.begin(), names.columns.end(), column) == names.columns.end())
      json_value.refuse("a key that is no column", "a column of the rows");
    const auto* const words = column == "measure"    ? &names.measures
                              : column == "field"    ? &names.fields
                              : column == "transfer" ? &names.transfers
                              : column == "scheme"   ? &names.schemes
                                                     : nullptr;
    auto& values = selector.emplace_back(column, std::vector<Value>{}).second;
    for (const JsonReader& item : json_value.is_array() ? json_value.items() : std::vector{json_value}) {
      values.push_back(read_value(item));
      if (words != nullptr) item.word({words->begin(), words->end()});
    }
  }
  if (selector.empty()) json.refuse("an object of 0 members", "at least one column and its value");
  return selector;
}

namespace {

std::optional<Selector> read_otherwise(const JsonReader& json, const RowNames& names) {
  const auto otherwise = json.find("otherwise");
  return otherwise ? std::optional(read_selector(*otherwise, names)) : std::nullopt;
}

}  // namespace

Claim read_claim(const JsonReader& json, const RowNames& names) {
  Claim claim;
  claim.name = json.at("claim").text();
  const JsonReader stated = json.at("stated");
  if (stated.is_number())
    claim.stated = stated.number();
  else
    claim.stated = stated.text();
  if (const auto why = json.find("why")) claim.why = why->text();
  if (const auto part = json.find("part")) claim.part = part->text();
  if (stated.is_number() && json.find("row")) {
    json.only({"claim", "part", "stated", "resolution", "row", "otherwise", "measured", "low", "high", "why"});
    claim.resolution = json.at("resolution").positive_number();
    claim.rows = read_selector(json.at("row"), names);
    claim.measured = read_column(json.at("measured"), names);
    if (const auto low = json.find("low")) claim.low = read_column(*low, names);
    if (const auto high = json.find("high")) claim.high = read_column(*high, names);
  } else if (stated.is_string() && json.find("rows")) {
    json.only({"claim", "part", "stated", "rows", "otherwise", "test", "why"});
    json.at("test").only({"column", "at_least", "at_most"});
    claim.rows = read_selector(json.at("rows"), names);
    claim.test = read_bound(json.at("test"), names);
  } else {
    json.only({"claim", "part", "stated", "why"});
    json.at("why").text();
  }
  claim.otherwise = read_otherwise(json, names);
  return claim;
}

Check read_check(const JsonReader& json, const RowNames& names) {
  json.only({"bound", "rows", "otherwise", "column", "at_least", "at_most"});
  return {.sentence = json.at("bound").text(),
          .rows = read_selector(json.at("rows"), names),
          .bound = read_bound(json, names),
          .otherwise = read_otherwise(json, names)};
}

Verdict judge(const Claim& claim, const std::vector<Row>& rows, const std::vector<Column>& columns) {
  if (!claim.rows) return not_comparable(claim.why);
  const Answering answer = answering(*claim.rows, claim.otherwise, rows);
  Verdict verdict = claim.test ? judge_sentence(claim, answer.rows, *claim.test, rows)
                               : judge_figure(claim, answer.rows, rows, columns);
  verdict.why = joined(answer.why, verdict.why);
  return verdict;
}

CheckOutcome judge(const Check& check, const std::vector<Row>& rows) {
  const Answering answer = answering(check.rows, check.otherwise, rows);
  const auto findings = collect(rows, answer.rows, check.bound.column);
  CheckOutcome outcome{false, {}, joined(answer.why, findings.missing)};
  if (findings.values.empty()) return outcome;
  outcome.measured = worst(findings, check.bound);
  outcome.holds = findings.missing == Value() && holds(worst(findings, check.bound), check.bound);
  return outcome;
}

const Value& cell(const Row& row, std::string_view name) {
  static const Value null;
  const auto found = std::find_if(row.begin(), row.end(), [name](const auto& item) { return item.first == name; });
  return found == row.end() ? null : found->second;
}

std::optional<double> as_number(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  return {};
}

}  // namespace raytruth
