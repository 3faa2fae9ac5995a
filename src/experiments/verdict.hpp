#pragma once

#include "experiments/row.hpp"
#include "raytruth/documents/json/json_reader.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

/// The rows whose cells equal one of the values, for every column named. A refused row lacks most of its cells: it is
/// among them unless one of those it has says otherwise.
using Selector = std::vector<std::pair<std::string, std::vector<Value>>>;

/// A column's value >= at_least, <= at_most, or both.
struct Bound {
  std::string column;
  std::optional<double> at_least = {};
  std::optional<double> at_most = {};
};

/// What is judged: a publication's claim; a finding, what no publication says but a reader should know; or a
/// publication's printed numbers against each other.
enum class StatementKind { claim, finding, consistency };
inline constexpr std::array<std::string_view, 3> statement_kinds{"claim", "finding", "internal consistency"};

/// What a publication states, and the rows that answer it: a figure, `stated` +- half of `resolution`, against the one
/// row selected; or a sentence, which `test` on all rows selected decides; or neither, where there is nothing to
/// measure and `why` says so.
struct Claim {
  std::string name;
  std::string part;  ///< which of several figures of the claim this is; empty: the only one
  StatementKind kind = StatementKind::claim;
  /// How the sentence is read and judged, in words, each under its name: reading, method, baseline, subject, criterion,
  /// deviation (from the criterion).
  std::vector<std::pair<std::string, std::string>> terms = {};
  Value stated;
  double resolution = 0;
  std::optional<Selector> rows;
  std::optional<Selector> otherwise = {};  ///< the rows that answer where all of `rows` are refused
  std::string measured;         ///< column of a figure; of a sentence, what is shown in place of the column tested
  std::string low;              ///< column; empty: measured minus its radius, or the least of all rows of a sentence
  std::string high;             ///< column; empty: measured plus its radius, or the largest of all rows
  std::string percentile = {};  ///< column of a figure: how much of what was measured lies below it; empty: none
  std::optional<Bound> test;
  std::string why;
};

/// A bound that an experiment asserts on all rows selected.
struct Check {
  std::string sentence;
  Selector rows;
  Bound bound;
  std::optional<Selector> otherwise = {};  ///< the rows that are bounded where all of `rows` are refused
};

/// What the rows say of a claim.
struct Verdict {
  Value measured;
  Value low;
  Value high;
  /// "not comparable"; of a claim "reproduced", "compatible" (with a range wider than a factor of 10) or
  /// "contradicted"; of a finding "found" or "not found"; of printed numbers "consistent" or "inconsistent".
  std::string verdict;
  Value why;
  std::string column = {};  ///< the one that `measured` is of
  std::string range = {};   ///< what low and high are
  Value percentile = {};    ///< of the stated figure among what was measured
};

/// What the rows say of a check; `measured` is the value that comes closest to breaking it.
struct CheckOutcome {
  bool holds = false;
  Value measured;
  double limit = 0;  ///< the one of the bound's that it is nearer to
  Value why;
};

/// What selectors and bounds may name.
struct RowNames {
  std::vector<std::string> columns;
  std::vector<std::string> measures;
  std::vector<std::string> fields;
  std::vector<std::string> transfers;
  std::vector<std::string> schemes;
};

/// Reads the rows that an experiment's claims, checks and plots name. Throws InputError.
Selector read_selector(const JsonReader& json, const RowNames& names);

/// Reads the members of an experiment's "published" and "checks". Throws InputError.
Claim read_claim(const JsonReader& json, const RowNames& names);
Check read_check(const JsonReader& json, const RowNames& names);

Verdict judge(const Claim& claim, const std::vector<Row>& rows, const std::vector<Column>& columns);
CheckOutcome judge(const Check& check, const std::vector<Row>& rows);

/// A cell of a row; null where the row has no such key.
const Value& cell(const Row& row, std::string_view name);

/// A cell as a number, if it is one.
std::optional<double> as_number(const Value& value);

}  // namespace raytruth
