#include "experiments/result.hpp"

#include "experiments/version.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(": ") + 2, line.size()));
  return "unknown";
}

Json columns_json(const std::vector<Column>& columns) {
  Json json = Json::object();
  for (const Column& column : columns) {
    Json& entry = json[column.name];
    entry = {{"unit", column.unit}, {"description", column.description}};
    if (column.is_key) entry["key"] = true;
    if (!column.radius.empty()) entry["radius"] = column.radius;
  }
  return json;
}

Json published_json(const Experiment& experiment, const std::vector<Row>& rows, const std::vector<Column>& columns) {
  Json json = Json::array();
  for (const Claim& claim : experiment.claims) {
    const Verdict verdict = judge(claim, rows, columns);
    Json& entry = json.emplace_back(Json{{"claim", claim.name}});
    if (!claim.part.empty()) entry["part"] = claim.part;
    if (claim.kind != StatementKind::claim) entry["kind"] = statement_kinds[static_cast<std::size_t>(claim.kind)];
    entry.update({{"stated", to_json(claim.stated)},
                  {"measured", to_json(verdict.measured)},
                  {"low", to_json(verdict.low)},
                  {"high", to_json(verdict.high)},
                  {"verdict", verdict.verdict},
                  {"why", to_json(verdict.why)}});
    if (verdict.measured != Value()) {
      const auto column = std::find_if(columns.begin(), columns.end(),
                                       [&verdict](const Column& c) { return c.name == verdict.column; });
      entry["unit"] = column == columns.end() ? "" : column->unit;
      entry["column"] = verdict.column;
      entry["range"] = verdict.range;
      if (verdict.percentile != Value()) entry["percentile"] = to_json(verdict.percentile);
    }
    for (const auto& [term, text] : claim.terms) entry[term] = text;
  }
  return json;
}

Json checks_json(const Experiment& experiment, const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Check& check : experiment.checks) {
    const CheckOutcome outcome = judge(check, rows);
    json.push_back({{"bound", check.sentence},
                    {"holds", outcome.holds},
                    {"measured", to_json(outcome.measured)},
                    {"limit", outcome.limit},
                    {"why", to_json(outcome.why)}});
  }
  return json;
}

/// How plots show the schemes.
Json styles_json(const Experiment& experiment) {
  Json json = Json::object();
  for (const std::string& name : experiment.schemes) {
    const IntegralScheme& scheme = *find_named(catalogue::integral_schemes(), name);
    json[name] = {{"color", scheme.color}, {"marker", scheme.marker}, {"label", scheme.summary}};
  }
  return json;
}

/// A cell of the table of claims.
std::string brief(const Json& value) {
  if (value.is_null()) return "-";
  return value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : shortened(value.get<std::string>());
}

}  // namespace

Json to_json(const Value& value) {
  return std::visit(
      [](const auto& alternative) -> Json {
        using Alternative = std::decay_t<decltype(alternative)>;
        if constexpr (std::is_same_v<Alternative, std::monostate>) {
          return nullptr;
        } else {
          if constexpr (std::is_same_v<Alternative, double>)
            if (!std::isfinite(alternative)) throw std::logic_error("a row holds a number that is not finite");
          return alternative;
        }
      },
      value);
}

Json to_json(const Row& row) {
  Json json = Json::object();
  for (const auto& [name, value] : row) json[name] = to_json(value);
  return json;
}

Row read_row(const JsonReader& json) {
  Row row;
  for (const auto& [name, item] : json.members()) {
    Value& value = row.emplace_back(name, Value{}).second;
    if (item.is_string())
      value = item.json().get<std::string>();
    else if (item.is_boolean())
      value = item.boolean();
    else if (item.json().is_number_integer())
      value = item.json().get<std::int64_t>();
    else if (!item.is_null())
      value = item.number();
  }
  return row;
}

Json build_identity() {
  return {{"version", version}, {"commit", commit}, {"compiler", compiler}, {"flags", flags}, {"cpu", cpu_name()}};
}

Json describe(const Field& field) {
  Json json{{"size", field.grid.size}, {"data_min", field.data_range.first}, {"data_max", field.data_range.second}};
  if (!field.file.empty()) json["file"] = field.file;
  if (!field.file.empty()) json["repaired"] = field.repaired;
  if (!field.warnings.empty()) json["warnings"] = field.warnings;
  return json;
}

std::string utc_text(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

int threads_in_use() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

Json to_json(const GlIdentity& gl) {
  return {{"platform", gl.platform}, {"vendor", gl.vendor}, {"renderer", gl.renderer}, {"version", gl.version}};
}

Json to_json(const Provenance& provenance) {
  Json json = build_identity();
  json["profile"] = provenance.profile;
  if (const auto& times = provenance.times) {
    json["threads"] = times->threads;
    json["seconds"] = std::round(times->seconds * 1000) / 1000;
    json["started"] = times->started;
    if (times->resumed) json["resumed"] = true;
    if (times->parts > 0) json["parts"] = times->parts;
  }
  if (provenance.programs) json["programs"] = true;
  if (provenance.gl) json["gl"] = to_json(*provenance.gl);
  return json;
}

Json make_result(const Experiment& experiment, const Provenance& provenance, const Json& fields,
                 const std::vector<Row>& rows) {
  const std::vector<Column> columns = result_columns(experiment);
  Json json_rows = Json::array();
  for (const Row& row : rows) json_rows.push_back(to_json(row));
  return {{"raytruth", "result/1"},
          {"experiment", experiment.json.json()},
          {"provenance", to_json(provenance)},
          {"styles", styles_json(experiment)},
          {"fields", fields},
          {"columns", columns_json(columns)},
          {"rows", std::move(json_rows)},
          {"published", published_json(experiment, rows, columns)},
          {"checks", checks_json(experiment, rows)}};
}

Json judged_again(const JsonReader& result, const Experiment& experiment) {
  Json was = result.at("experiment").json();
  Json is = experiment.json.json();
  for (const char* const words : {"question", "source", "published", "checks", "plot"}) {
    was.erase(words);
    is.erase(words);
  }
  const auto need_same = [&result](const Json& here, const Json& there) {
    for (const auto& [name, member] : here.items())
      if (!there.contains(name) || there[name] != member)
        result.at("experiment")
            .refuse("a run whose \"" + name + "\" is another one", "rows of the experiment as it is; run it");
  };
  need_same(is, was);
  need_same(was, is);  // what the experiment no longer has
  std::vector<Row> rows;
  for (const JsonReader& row : result.at("rows").items(0)) rows.push_back(read_row(row));
  std::vector<Column> columns;
  for (const auto& [name, column] : result.at("columns").members()) {
    const auto radius = column.find("radius");
    columns.push_back({.name = name,
                       .unit = column.at("unit").json().get<std::string>(),
                       .description = {},
                       .radius = radius ? radius->text() : ""});
  }
  Json judged = result.json();
  judged["experiment"] = experiment.json.json();
  judged["provenance"]["judged"] = {{"version", version}, {"commit", commit}};
  judged["published"] = published_json(experiment, rows, columns);
  judged["checks"] = checks_json(experiment, rows);
  return judged;
}

std::string result_text(const Json& result) {
  std::string text = "{";
  for (const auto& [key, value] : result.items()) {
    text += fmt::format("{}\n  {}: ", text.size() > 1 ? "," : "", Json(key).dump());
    if (!value.is_structured() || value.empty()) {
      text += value.dump();
      continue;
    }
    text += value.is_array() ? "[" : "{";
    std::string_view separator;
    for (const auto& [name, item] : value.items()) {
      text += fmt::format("{}\n    {}{}", separator, value.is_array() ? "" : Json(name).dump() + ": ", item.dump());
      separator = ",";
    }
    text += value.is_array() ? "\n  ]" : "\n  }";
  }
  return text + "\n}\n";
}

JsonReader read_result(const std::string& path) {
  JsonReader result = JsonReader::from_file(path);
  result.at("raytruth").word({"result/1"});
  result.at("experiment").members();
  result.at("provenance").members();
  for (const auto& [name, column] : result.at("columns").members()) {
    if (const auto key = column.find("key")) key->boolean();
    if (const auto radius = column.find("radius")) radius->text();
  }
  for (const JsonReader& row : result.at("rows").items(0)) {
    for (const auto& [name, value] : row.members())
      if (value.is_object() || value.is_array()) value.refuse_value("a text, a number, true, false or null");
  }
  for (const JsonReader& claim : result.at("published").items(0)) {
    claim.at("claim").text();
    claim.at("verdict").text();
  }
  for (const JsonReader& check : result.at("checks").items(0)) {
    check.at("bound").text();
    check.at("holds").boolean();
  }
  return result;
}

std::string claims_table(const Json& claims) {
  const auto cell = [](const Json& claim, const char* name) {
    return claim.contains(name) ? brief(claim.at(name)) : "-";
  };
  std::vector<std::array<std::string, 5>> table{{"claim", "published", "measured", "verdict", "experiment"}};
  for (const Json& claim : claims) {
    const std::string part = cell(claim, "part");
    table.push_back({cell(claim, "claim") + (part == "-" ? "" : fmt::format(" ({})", part)), cell(claim, "stated"),
                     claim.at("measured").is_null() ? "-"
                                                    : fmt::format("{} ({} .. {})", cell(claim, "measured"),
                                                                  cell(claim, "low"), cell(claim, "high")),
                     cell(claim, "verdict"), cell(claim, "experiment")});
  }
  if (table.size() == 1) return {};
  const bool has_experiments = claims.front().contains("experiment");
  std::array<std::size_t, 4> widths{};
  for (const auto& line : table)
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : table) {
    text += fmt::format("{:<{}}  {:<{}}  {:<{}}  ", line[0], widths[0], line[1], widths[1], line[2], widths[2]);
    text += has_experiments ? fmt::format("{:<{}}  {}\n", line[3], widths[3], line[4]) : line[3] + "\n";
  }
  return text;
}

std::vector<std::string> broken_checks(const Json& result) {
  std::vector<std::string> lines;
  for (const Json& check : result.at("checks")) {
    if (check.at("holds").get<bool>()) continue;
    if (check.at("measured").is_null()) {
      lines.push_back(fmt::format("check: nothing to measure: {} ({})", check.at("bound").get<std::string>(),
                                  brief(check.at("why"))));
      continue;
    }
    lines.push_back(fmt::format("check: does not hold: {}: measured {}, limit {}{}",
                                check.at("bound").get<std::string>(), brief(check.at("measured")),
                                brief(check.at("limit")),
                                check.at("why").is_null() ? "" : " (" + brief(check.at("why")) + ")"));
  }
  return lines;
}

}  // namespace raytruth
