#include "experiments/verdict.hpp"

#include "experiments/criteria.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace raytruth {

namespace {

/// How a claim is read and judged, in words.
constexpr std::array<std::string_view, 6> claim_terms{"reading", "method",    "baseline",
                                                      "subject", "criterion", "deviation"};

Value read_value(const JsonReader& json) {
  if (json.is_string()) return json.text();
  if (json.is_boolean()) return json.boolean();
  if (json.is_null()) return {};
  return json.number();
}

std::string read_column(const JsonReader& json, const RowNames& names) {
  return json.word({names.columns.begin(), names.columns.end()});
}

/// The limits stated, or those of a criterion where none is.
Bound read_bound(const JsonReader& json, const RowNames& names, const Criterion* criterion = nullptr) {
  Bound bound{.column = read_column(json.at("column"), names)};
  if (const auto least = json.find("at_least")) bound.at_least = least->number();
  if (const auto most = json.find("at_most")) bound.at_most = most->number();
  if (!bound.at_least && !bound.at_most && criterion != nullptr) {
    bound.at_least = criterion->at_least;
    bound.at_most = criterion->at_most;
    if (!bound.at_least && !bound.at_most)
      json.refuse("no limit, and none of its criterion", "at_least, at_most or both");
  } else if (!bound.at_least && !bound.at_most) {
    bound.at_most = json.at("at_most").number();  // refuses its absence
  }
  if (bound.at_least && bound.at_most && *bound.at_least > *bound.at_most)
    json.refuse("at_least above at_most", "at_least <= at_most");
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

/// The verdict of a statement of a kind that holds or does not; `is_wide`: within a range that holds almost anything.
std::string word_for(StatementKind kind, bool does_hold, bool is_wide) {
  switch (kind) {
    case StatementKind::finding:
      return does_hold ? "found" : "not found";
    case StatementKind::consistency:
      return does_hold ? "consistent" : "inconsistent";
    case StatementKind::claim:
      break;
  }
  if (!does_hold) return "contradicted";
  return is_wide ? "compatible" : "reproduced";
}

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
  constexpr double widest = 10;
  const bool is_spread = !claim.low.empty() && !claim.high.empty();
  const bool is_wide = is_spread && !(*low > 0 && *high <= widest * *low);
  return {*measured,
          *low,
          *high,
          word_for(claim.kind, meets, is_wide),
          stated_why(claim),
          claim.measured,
          is_spread ? claim.low + " to " + claim.high : "give or take its radius",
          claim.percentile.empty() ? Value() : cell(row, claim.percentile)};
}

/// What the rows selected say of a bound.
struct BoundFindings {
  std::vector<std::pair<double, const Row*>> values;  ///< ascending
  Value missing;                                      ///< why a value is missing, if one is
};

/// Refused rows say nothing unless there are no others.
BoundFindings collect(const std::vector<Row>& rows, const Selector& selector, const std::string& column) {
  BoundFindings findings;
  const auto selected = select(rows, selector);
  if (selected.empty()) findings.missing = "no row is selected";
  for (const Row* row : selected) {
    const auto value = as_number(cell(*row, column));
    if (value)
      findings.values.emplace_back(*value, row);
    else if (!is_refused(*row))
      findings.missing = why_missing(column);
  }
  if (findings.values.empty() && findings.missing == Value()) findings.missing = why_refused(*selected.front());
  std::stable_sort(findings.values.begin(), findings.values.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return findings;
}

/// How far a value is inside of a bound; negative: it breaks it.
double margin(double value, const Bound& bound) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return std::min(bound.at_least ? value - *bound.at_least : infinity,
                  bound.at_most ? *bound.at_most - value : infinity);
}

/// The one that comes closest to breaking the bound, or breaks it most.
const std::pair<double, const Row*>& worst(const BoundFindings& findings, const Bound& bound) {
  const auto& [first, last] = std::tie(findings.values.front(), findings.values.back());
  return margin(first.first, bound) <= margin(last.first, bound) ? first : last;
}

bool holds(double value, const Bound& bound) { return margin(value, bound) >= 0; }

Verdict judge_sentence(const Claim& claim, const Selector& selector, const Bound& test, const std::vector<Row>& rows) {
  const auto findings = collect(rows, selector, test.column);
  if (findings.missing != Value()) return not_comparable(findings.missing);
  const auto& [tested, row] = worst(findings, test);
  Verdict verdict{
      tested,
      findings.values.front().first,
      findings.values.back().first,
      word_for(claim.kind, holds(tested, test), false),
      stated_why(claim),
      test.column,
      findings.values.size() == 1 ? "the one row" : fmt::format("extremes of {} rows", findings.values.size())};
  if (claim.measured.empty()) return verdict;
  verdict.column = claim.measured;
  verdict.range = claim.low + " to " + claim.high;
  verdict.measured = cell(*row, claim.measured);
  verdict.low = cell(*row, claim.low);
  verdict.high = cell(*row, claim.high);
  return verdict;
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

namespace {

/// The members that every claim may have, and those of its form.
void only(const JsonReader& json, std::vector<std::string_view> members) {
  members.insert(members.end(), {"claim", "part", "kind", "stated", "why"});
  members.insert(members.end(), claim_terms.begin(), claim_terms.end());
  json.only(members);
}

const Criterion* read_criterion(const JsonReader& json) {
  const auto stated = json.find("criterion");
  if (!stated) return nullptr;
  std::vector<std::string_view> allowed;
  for (const Criterion& criterion : criteria()) allowed.push_back(criterion.name);
  const std::string name = stated->word(allowed);
  return &*std::find_if(criteria().begin(), criteria().end(),
                        [&name](const Criterion& criterion) { return criterion.name == name; });
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
  if (const auto kind = json.find("kind")) {
    const std::string word = kind->word({statement_kinds.begin(), statement_kinds.end()});
    claim.kind = static_cast<StatementKind>(std::find(statement_kinds.begin(), statement_kinds.end(), word) -
                                            statement_kinds.begin());
  }
  for (const std::string_view term : claim_terms)
    if (const auto text = json.find(term)) claim.terms.emplace_back(term, text->text());
  const Criterion* const criterion = read_criterion(json);
  if (stated.is_number() && json.find("row")) {
    only(json, {"resolution", "row", "otherwise", "measured", "low", "high", "percentile"});
    claim.resolution = json.at("resolution").positive_number();
    claim.rows = read_selector(json.at("row"), names);
    claim.measured = read_column(json.at("measured"), names);
    if (const auto low = json.find("low")) claim.low = read_column(*low, names);
    if (const auto high = json.find("high")) claim.high = read_column(*high, names);
    if (const auto percentile = json.find("percentile")) claim.percentile = read_column(*percentile, names);
  } else if (stated.is_string() && json.find("rows")) {
    only(json, {"rows", "otherwise", "test", "measured", "low", "high"});
    json.at("test").only({"column", "at_least", "at_most"});
    claim.rows = read_selector(json.at("rows"), names);
    claim.test = read_bound(json.at("test"), names, criterion);
    if (const auto measured = json.find("measured")) {
      claim.measured = read_column(*measured, names);
      claim.low = read_column(json.at("low"), names);
      claim.high = read_column(json.at("high"), names);
    }
  } else {
    only(json, {});
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
  CheckOutcome outcome{.holds = false,
                       .measured = {},
                       .limit = check.bound.at_least.value_or(check.bound.at_most.value_or(0)),
                       .why = joined(answer.why, findings.missing)};
  if (findings.values.empty()) return outcome;
  const double measured = worst(findings, check.bound).first;
  outcome.measured = measured;
  outcome.holds = findings.missing == Value() && holds(measured, check.bound);
  outcome.limit = check.bound.at_least && check.bound.at_most
                      ? (measured - *check.bound.at_least <= *check.bound.at_most - measured ? *check.bound.at_least
                                                                                             : *check.bound.at_most)
                      : check.bound.at_least.value_or(check.bound.at_most.value_or(0));
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
