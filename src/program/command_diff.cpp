#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "experiments/verdict.hpp"
#include "program/command.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace raytruth {

namespace {

struct DiffOptions {
  std::string before;
  std::string after;
  bool json = false;
  bool check = false;
};

using Json = nlohmann::ordered_json;

/// The columns that identify a row, and the radius column of every column that has one.
struct RowShape {
  std::vector<std::string> keys;
  std::map<std::string, std::string> radius;
};

RowShape shape_of(const JsonReader& result) {
  RowShape shape;
  for (const auto& [name, column] : result.at("columns").members()) {
    if (const auto key = column.find("key"); key && key->boolean()) shape.keys.push_back(name);
    if (const auto radius = column.find("radius")) shape.radius[name] = radius->text();
  }
  if (shape.keys.empty())
    result.at("columns").refuse("no column that is a key", "\"key\": true in at least one column");
  return shape;
}

/// Rows by their keys, as in {"measure": "signal_error", "field": "white"}.
std::map<std::string, Row> rows_by_key(const JsonReader& result, const RowShape& shape) {
  std::map<std::string, Row> rows;
  for (const JsonReader& json : result.at("rows").items(0)) {
    Row row = read_row(json);
    Json key = Json::object();
    for (const std::string& name : shape.keys)
      if (cell(row, name) != Value()) key[name] = to_json(cell(row, name));
    if (!rows.emplace(key.dump(), std::move(row)).second) json.refuse("a second row with the key " + key.dump(), "one");
  }
  return rows;
}

double radius_in(const Row& row, const RowShape& shape, const std::string& column) {
  const auto found = shape.radius.find(column);
  return found == shape.radius.end() ? 0 : as_number(cell(row, found->second)).value_or(0);
}

/// Whether the column holds the radius of another: a bound on an error, not a finding.
bool is_radius(const RowShape& shape, const std::string& column) {
  return std::any_of(shape.radius.begin(), shape.radius.end(),
                     [&column](const auto& entry) { return entry.second == column; });
}

/// Whether the cells differ by more than both radii together: two intervals that do not meet.
bool differ(const Value& before, const Value& after, double radii) {
  const auto x = as_number(before);
  const auto y = as_number(after);
  return x && y ? std::abs(*x - *y) > radii : before != after;
}

struct Differences {
  Json experiment = Json::array();  ///< of the experiments themselves, which explain the others
  Json added = Json::array();
  Json removed = Json::array();
  Json changed = Json::array();
  Json verdicts = Json::array();
  Json checks = Json::array();

  [[nodiscard]] bool is_empty() const {
    return added.empty() && removed.empty() && changed.empty() && verdicts.empty() && checks.empty();
  }
};

void compare_rows(const JsonReader& before, const JsonReader& after, Differences& differences) {
  const RowShape old_shape = shape_of(before);
  const RowShape new_shape = shape_of(after);
  const auto old_rows = rows_by_key(before, old_shape);
  const auto new_rows = rows_by_key(after, new_shape);
  for (const auto& [key, row] : old_rows)
    if (!new_rows.contains(key)) differences.removed.push_back(Json::parse(key));
  for (const auto& [key, row] : new_rows) {
    const auto old = old_rows.find(key);
    if (old == old_rows.end()) {
      differences.added.push_back(Json::parse(key));
      continue;
    }
    std::vector<std::string> columns;
    for (const Row& side : {old->second, row})
      for (const auto& [name, value] : side)
        if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
    for (const std::string& column : columns) {
      if (is_radius(old_shape, column) || is_radius(new_shape, column)) continue;
      const Value& x = cell(old->second, column);
      const Value& y = cell(row, column);
      const double radii = radius_in(old->second, old_shape, column) + radius_in(row, new_shape, column);
      if (differ(x, y, radii))
        differences.changed.push_back({{"row", Json::parse(key)},
                                       {"column", column},
                                       {"before", to_json(x)},
                                       {"after", to_json(y)},
                                       {"radii", radii}});
    }
  }
}

/// Differences of one member of the statements (claims, checks) that both results name alike.
Json compare_statements(const JsonReader& before, const JsonReader& after, const char* list, const char* name,
                        const char* member) {
  // A claim of several parts is several statements; a key that comes twice is told apart by its number.
  std::map<Json, std::vector<Json>> old;
  const auto key_of = [name](const JsonReader& statement) {
    Json key{{name, statement.at(name).json()}};
    if (const auto part = statement.find("part")) key["part"] = part->json();
    return key;
  };
  const auto change = [](Json key, const Json& was, const Json& is) {
    key.update({{"before", was}, {"after", is}});
    return key;
  };
  for (const JsonReader& statement : before.at(list).items(0))
    old[key_of(statement)].push_back(statement.at(member).json());
  Json changes = Json::array();
  for (const JsonReader& statement : after.at(list).items(0)) {
    const Json key = key_of(statement);
    const Json& is = statement.at(member).json();
    auto& alike = old[key];
    const Json was = alike.empty() ? Json() : alike.front();
    if (!alike.empty()) alike.erase(alike.begin());
    if (was != is) changes.push_back(change(key, was, is));
  }
  for (const auto& [key, left] : old)
    for (const Json& was : left) changes.push_back(change(key, was, nullptr));
  return changes;
}

/// The members of the experiments that are not the same, with their JSON pointers: {"place", "before", "after"}.
/// Objects are compared member by member; what fills more than a line is left to the reader.
void compare_experiments(const Json& before, const Json& after, const std::string& place, Json& changes) {
  if (before == after) return;
  if (before.is_object() && after.is_object()) {
    std::set<std::string> names;
    for (const Json& side : {before, after})
      for (const auto& [name, member] : side.items()) names.insert(name);
    for (const std::string& name : names)
      compare_experiments(before.value(name, Json()), after.value(name, Json()), place + "/" + name, changes);
    return;
  }
  changes.push_back({{"place", place}, {"before", before}, {"after", after}});
}

std::string readable(const Differences& differences) {
  std::string text;
  for (const Json& change : differences.experiment)
    text += fmt::format("experiment {}: {} -> {}\n", change["place"].get<std::string>(),
                        shortened(change["before"].dump()), shortened(change["after"].dump()));
  for (const Json& row : differences.removed) text += fmt::format("removed {}\n", row.dump());
  for (const Json& row : differences.added) text += fmt::format("added   {}\n", row.dump());
  for (const Json& change : differences.changed)
    text += fmt::format("changed {} {}: {} -> {}\n", change["row"].dump(), change["column"].get<std::string>(),
                        change["before"].dump(), change["after"].dump());
  for (const Json& change : differences.verdicts)
    text += fmt::format("verdict {}{}: {} -> {}\n", change["claim"].get<std::string>(),
                        change.contains("part") ? fmt::format(" ({})", change["part"].get<std::string>()) : "",
                        change["before"].dump(), change["after"].dump());
  for (const Json& change : differences.checks)
    text += fmt::format("check   {}: {} -> {}\n", change["bound"].get<std::string>(), change["before"].dump(),
                        change["after"].dump());
  return differences.is_empty() ? text + "nothing changed beyond both radii\n" : text;
}

int compare_results(const DiffOptions& options) {
  const JsonReader before = read_result(options.before);
  const JsonReader after = read_result(options.after);
  Differences differences;
  const auto experiment_of = [](const JsonReader& result) { return result.at("experiment").json(); };
  compare_experiments(experiment_of(before), experiment_of(after), "", differences.experiment);
  const std::string old_name = before.at("experiment").at("name").text();
  const std::string new_name = after.at("experiment").at("name").text();
  if (old_name != new_name)
    say(fmt::format("warning: these are results of different experiments: {} of {}, {} of {}", options.before, old_name,
                    options.after, new_name));
  compare_rows(before, after, differences);
  differences.verdicts = compare_statements(before, after, "published", "claim", "verdict");
  differences.checks = compare_statements(before, after, "checks", "bound", "holds");
  const Json json{{"experiment", differences.experiment}, {"added", differences.added},
                  {"removed", differences.removed},       {"changed", differences.changed},
                  {"verdicts", differences.verdicts},     {"checks", differences.checks}};
  print(options.json ? json.dump(2) + "\n" : readable(differences));
  return options.check && !differences.is_empty() ? 1 : 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<DiffOptions>();
  add.operand("before", options->before, "JSON file");
  add.operand("after", options->after, "JSON file");
  add.flag("--json", options->json, "As JSON");
  add.flag("--check", options->check, "Exit with 1 if something changed");
  return [options] { return compare_results(*options); };
}

}  // namespace

extern const Command diff_command;
const Command diff_command{
    .name = "diff",
    .summary = "Tell what changed between two results, beyond both radii",
    .example = "raytruth diff results/xi_adaptive.json out/xi_adaptive.json",
    .notes =
        "What the experiments themselves do not share comes first, by its place in them; it is no change of\n"
        "the result, so --check passes over it.",
    .describe = describe};

}  // namespace raytruth
