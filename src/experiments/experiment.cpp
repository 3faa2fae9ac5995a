#include "experiments/experiment.hpp"

#include "experiments/experiment_as_run.hpp"
#include "experiments/measure.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/documents/case_json.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/reference/ray_integral.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t largest_seed = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t most_plot_columns = 8;
constexpr std::int64_t most_rays = 100'000'000;
constexpr double largest_optical_depth = 1e6;

/// The text at items[i][key], or items[i] itself for an empty key, of the list at document[list].
std::vector<Json> words_in(const Json& document, const char* list, const char* key) {
  std::vector<Json> words;
  if (!document.contains(list) || !document[list].is_array()) return words;
  for (const Json& item : document[list])
    if (item.is_string())
      words.push_back(item);
    else if (item.is_object() && item.contains(key))
      words.push_back(item[key]);
  return words;
}

/// Takes what `lost` holds out of a selector's value; true where nothing is left of it.
bool is_lost(Json& value, const std::vector<Json>& lost) {
  const auto is_in_lost = [&lost](const Json& word) { return std::find(lost.begin(), lost.end(), word) != lost.end(); };
  if (!value.is_array()) return is_in_lost(value);
  const bool was_empty = value.empty();
  value.erase(std::remove_if(value.begin(), value.end(), is_in_lost), value.end());
  return value.empty() && !was_empty;
}

/// Drops the claims, checks or panels that speak only of rows that are lost: those of `lost` words in `column`. A claim
/// or check that says what else answers keeps that.
void drop_statements(Json& statements, const std::string& column, const std::vector<Json>& lost) {
  if (!statements.is_array()) return;
  const auto are_lost = [&](Json& statement, const char* rows) {
    return statement.is_object() && statement.contains(rows) && statement[rows].is_object() &&
           statement[rows].contains(column) && is_lost(statement[rows][column], lost);
  };
  const auto is_about_lost = [&](Json& statement) {
    const bool is_otherwise_lost = are_lost(statement, "otherwise");
    for (const char* const rows : {"row", "rows"}) {
      if (!are_lost(statement, rows)) continue;
      if (is_otherwise_lost || !statement.contains("otherwise")) return true;
      statement[rows] = statement["otherwise"];
      statement.erase("otherwise");
    }
    if (is_otherwise_lost) statement.erase("otherwise");
    return false;
  };
  statements.erase(std::remove_if(statements.begin(), statements.end(), is_about_lost), statements.end());
}

/// Merges the quick version into the document, and drops what is said about rows that it does not make.
void merge_quick(Json& document) {
  const Json full = document;
  document.merge_patch(full["quick"]);
  const bool has_panels = document.contains("plot") && document["plot"].is_object() &&
                          document["plot"].contains("panels") && !document["plot"]["panels"].empty();
  for (const auto& [column, list, key] : {std::tuple{"field", "fields", "name"},
                                          {"transfer", "transfer_functions", "name"},
                                          {"scheme", "schemes", "name"},
                                          {"measure", "measures", "kind"}}) {
    std::vector<Json> lost = words_in(full, list, key);
    const std::vector<Json> kept = words_in(document, list, key);
    std::erase_if(lost, [&kept](const Json& word) { return std::find(kept.begin(), kept.end(), word) != kept.end(); });
    if (lost.empty()) continue;
    for (const char* const statements : {"published", "checks"})
      if (document.contains(statements)) drop_statements(document[statements], column, lost);
    if (has_panels) drop_statements(document["plot"]["panels"], column, lost);
  }
  if (has_panels && document["plot"]["panels"].empty()) document.erase("plot");
}

void fill_in_defaults(Json& document) {
  document.emplace("seed", 1);
  document.emplace("samplings", Json::array({{{"kind", "cells"}}}));
  document.emplace("published", Json::array());
  document.emplace("checks", Json::array());
  if (document.contains("transfer_functions")) document.emplace("emission", "associated");
  if (!document.contains("fields") || !document["fields"].is_array()) return;
  for (Json& field : document["fields"]) fill_in_field_defaults(field);
}

/// Refuses a second item of the same name.
void add_unique(std::vector<std::string>& names, const JsonReader& place, std::string name) {
  if (std::find(names.begin(), names.end(), name) != names.end()) place.refuse_value("each name once");
  names.push_back(std::move(name));
}

/// A word that can be a file's name and a cell of a table.
std::string read_name(const JsonReader& json) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  std::string name = json.text();
  if (name.find_first_not_of(letters) != std::string::npos || name.front() == '.')
    json.refuse_value("a name of letters, digits, '_', '-' and '.', not beginning with '.',");
  return name;
}

OutsideProgram read_program(const JsonReader& json) {
  OutsideProgram program = read_outside_program(json);
  if (find_named(catalogue::integral_schemes(), read_name(json.at("name"))) != nullptr)
    json.at("name").refuse_value("a name that no scheme has");
  return program;
}

/// The extinction of the studies' transfer functions is such that a ray that meets the largest one all along has the
/// optical depth stated.
PiecewiseLinear read_transfer(const JsonReader& json, Experiment& experiment) {
  const std::string kind = json.at("kind").word(names_of(catalogue::transfers));
  const auto& entry = *find_named(catalogue::transfers, kind);
  if (entry.make == nullptr) {
    json.only({"name", "kind", "transfer_function"});
    const JsonReader place = json.at("transfer_function");
    PiecewiseLinear transfer = read_transfer_function(place, {}, experiment.warnings).transfer;
    place.blame_for([&] { return RayIntegral(transfer, experiment.emission); });  // refuses what it cannot enclose
    return transfer;
  }
  json.only({"name", "kind", "optical_depth"});
  const double depth = json.at("optical_depth").number(0, largest_optical_depth);
  return entry.make(depth / experiment.rays.length, experiment.seed);
}

void read_transfers(const JsonReader& json, Experiment& experiment) {
  const auto transfers = json.find("transfer_functions");
  const auto emission = json.find("emission");
  if (!transfers && emission) emission->refuse_value("transfer_functions beside it, or nothing,");
  if (!transfers) return;
  if (json.at("emission").word({"associated", "plain"}) == "plain") experiment.emission = Emission::plain;
  std::vector<std::string> names;
  for (const JsonReader& item : transfers->items()) {
    add_unique(names, item.at("name"), read_name(item.at("name")));
    experiment.transfers.push_back({names.back(), read_transfer(item, experiment)});
  }
}

void check_range(const JsonReader& json) {
  const auto ends = json.items(2);
  if (ends.size() != 2) json.refuse(fmt::format("{} items", ends.size()), "a pair of numbers");
  if (!(ends[0].number() < ends[1].number())) ends[1].refuse_value(fmt::format("a number > {}", ends[0].number()));
}

/// [2, 3] is the second of three.
void check_part(const JsonReader& json) {
  const auto numbers = json.items(2);
  if (numbers.size() != 2) json.refuse(fmt::format("{} items", numbers.size()), "a pair of numbers");
  numbers[0].integer(1, numbers[1].integer(1, most_plot_columns));
}

void check_panel(const JsonReader& json, const RowNames& names) {
  const std::vector<std::string_view> columns(names.columns.begin(), names.columns.end());
  const std::string kind = json.at("kind").word({"quantiles", "points", "lines", "scatter", "image"});
  read_selector(json.at("rows"), names);
  if (kind == "image") {
    json.only({"kind", "rows", "line", "pixels", "is_color", "turned", "label"});
    for (const char* const column : {"line", "pixels"}) json.at(column).word(columns);
    if (const auto is_color = json.find("is_color")) is_color->boolean();
    if (const auto turned = json.find("turned")) turned->word({"left", "right"});
    json.at("label").text();
    return;
  }
  json.at("series").word(columns);
  if (const auto title = json.find("title")) title->text();
  if (kind == "lines" || kind == "scatter") {
    for (const char* const column : {"x", "y"}) json.at(column).word(columns);
    for (const char* const label : {"label_x", "label_y"}) json.at(label).text();
    for (const char* const log : {"log_x", "log_y"})
      if (const auto found = json.find(log)) found->boolean();
    for (const char* const range : {"x_range", "y_range"})
      if (const auto found = json.find(range)) check_range(*found);
  }
  if (kind == "scatter") {
    json.only({"kind", "rows", "title", "x", "y", "series", "label_x", "label_y", "log_x", "log_y", "x_range",
               "y_range", "diagonal"});
    if (const auto diagonal = json.find("diagonal")) diagonal->boolean();
    return;
  }
  if (kind == "lines") {
    json.only({"kind", "rows", "title", "x", "y", "series", "front", "label_x", "label_y", "log_x", "log_y", "x_range",
               "y_range", "floor"});
    if (const auto front = json.find("front")) front->word(columns);
    if (const auto floor = json.find("floor")) floor->number();
    return;
  }
  if (kind == "points") {
    json.only({"kind", "rows", "title", "value", "low", "high", "group", "part", "series", "printed", "log", "label"});
    json.at("value").word(columns);
    for (const char* const end : {"low", "high"})
      if (const auto column = json.find(end)) column->word(columns);
  } else {
    json.only({"kind", "rows", "title", "value", "group", "part", "series", "printed", "log", "label"});
    json.at("value").text();
  }
  json.at("group").word(columns);
  if (const auto part = json.find("part")) check_part(*part);
  if (const auto printed = json.find("printed")) printed->word(columns);
  if (const auto log = json.find("log")) log->boolean();
  json.at("label").text();
}

void check_plot(const JsonReader& json, const RowNames& names) {
  json.only({"title", "note", "columns", "image_columns", "names", "panels"});
  json.at("title").text();
  if (const auto note = json.find("note")) note->text();
  for (const char* const key : {"columns", "image_columns"})
    if (const auto columns = json.find(key)) columns->integer(1, most_plot_columns);
  if (const auto readable = json.find("names"))
    for (const auto& [word, name] : readable->members()) name.text();
  for (const JsonReader& panel : json.at("panels").items()) check_panel(panel, names);
}

std::vector<Claim> read_claims(const JsonReader& json, const RowNames& names) {
  std::vector<Claim> claims;
  std::vector<std::string> seen;
  for (const JsonReader& item : json.items(0)) {
    claims.push_back(read_claim(item, names));
    add_unique(seen, item.at("claim"), claims.back().name + "/" + claims.back().part);
  }
  return claims;
}

std::vector<Check> read_checks(const JsonReader& json, const RowNames& names) {
  std::vector<Check> checks;
  for (const JsonReader& item : json.items(0)) checks.push_back(read_check(item, names));
  return checks;
}

void need_schemes(const Experiment& experiment) {
  if (experiment.schemes.empty() && experiment.programs.empty())
    experiment.json.refuse("no schemes", "a member \"schemes\"");
}

/// Programs answer whole rays and images; other measures look into schemes.
void refuse_programs(const Experiment& experiment, const JsonReader& measure) {
  if (!experiment.programs.empty())
    measure.refuse(fmt::format("a measure of schemes beside the program {}", experiment.programs.front().name),
                   "conformance");
}

void need_signal_schemes(const Experiment& experiment) {
  const auto names = catalogue::scheme_names();
  for (const JsonReader& scheme : experiment.json.at("schemes").items()) scheme.word(names);
}

void need_usable_samplings(const Experiment& experiment, const JsonReader& measure) {
  for (const Sampling& sampling : experiment.samplings)
    for (const std::string& scheme : experiment.schemes)
      catalogue::visit_scheme(scheme, [&]<class S>() {
        const Samples<double> samples{.positions = {}, .values = {}, .step = sampling.step};
        const std::string_view why = refusal<S>(samples);
        if (!why.empty()) measure.refuse(fmt::format("{} with {} samples", scheme, sampling.kind), why);
      });
}

void need_transfers(const Experiment& experiment) {
  if (experiment.transfers.empty()) experiment.json.refuse("no transfer functions", "a member \"transfer_functions\"");
}

/// Refuses an experiment that lacks what a measure needs; `place` is where the experiment asks for it.
void refuse_lacks(const Needs& needs, const Experiment& experiment, const JsonReader& place) {
  if (needs.schemes || needs.signal_schemes) need_schemes(experiment);
  if ((needs.schemes || needs.signal_schemes) && !needs.takes_programs) refuse_programs(experiment, place);
  if (needs.signal_schemes) need_signal_schemes(experiment);
  if (needs.usable_samplings) need_usable_samplings(experiment, place);
  if (needs.transfers) need_transfers(experiment);
}

bool has_gl_measure(const Json& document) {
  const auto kinds = words_in(document, "measures", "kind");
  return std::any_of(measures().begin(), measures().end(), [&kinds](const Measure* measure) {
    return measure->uses_gl && std::find(kinds.begin(), kinds.end(), Json(measure->name)) != kinds.end();
  });
}

/// Studies keep three numbers at least of every ray, for each way to approximate it.
void check_memory_of_rays(const Experiment& experiment) {
  const auto ways = experiment.samplings.size() * std::max<std::size_t>(1, experiment.schemes.size());
  experiment.json.at("rays").at("count").blame_for([&] {
    need_memory(3 * sizeof(double) * static_cast<std::uint64_t>(experiment.rays.count) * ways,
                fmt::format("{} rays by {} schemes and samplings", experiment.rays.count, ways));
  });
}

/// The document as it is run.
JsonReader read_document(const JsonReader& file, std::string_view profile, std::optional<std::int64_t> seed,
                         const std::optional<std::string>& gl) {
  file.at("raytruth").word({"experiment/1"});
  Json document = file.json();
  if (const auto quick = file.find("quick")) {
    quick->members();
    if (profile == "quick") merge_quick(document);
    document.erase("quick");
  }
  fill_in_defaults(document);
  if (seed) document["seed"] = *seed;
  if (gl && has_gl_measure(document)) document["gl"] = *gl;
  return JsonReader::from_json(std::move(document), file);
}

}  // namespace

const Measure& measure_of(const JsonReader& options) {
  const std::string kind = options.at("kind").word(names_of(measures()));
  return *find_named(measures(), kind);
}

bool uses_gl(const Experiment& experiment) { return has_gl_measure(experiment.json.json()); }

Experiment read_experiment(const std::string& path, std::string_view profile, std::optional<std::int64_t> seed,
                           const std::optional<std::string>& gl) {
  return read_experiment(JsonReader::from_file(path), profile, seed, gl);
}

Experiment read_experiment(const JsonReader& document, std::string_view profile, std::optional<std::int64_t> seed,
                           const std::optional<std::string>& gl) {
  return read_experiment_as_run(read_document(document, profile, seed, gl));
}

Experiment read_experiment_as_run(const JsonReader& json) {
  json.only({"raytruth", "name", "question", "source", "seed", "gl", "fields", "rays", "transfer_functions", "emission",
             "samplings", "schemes", "measures", "published", "checks", "plot"});
  Experiment experiment{.name = read_name(json.at("name")),
                        .seed = static_cast<std::uint64_t>(json.at("seed").integer(0, largest_seed)),
                        .fields = {},
                        .rays = {},
                        .transfers = {},
                        .emission = Emission::associated,
                        .samplings = {},
                        .schemes = {},
                        .programs = {},
                        .measures = {},
                        .claims = {},
                        .checks = {},
                        .json = json};
  if (const auto stated = json.find("gl")) {
    if (!uses_gl(experiment)) stated->refuse_value("a measure of shaders beside it, or nothing,");
    const std::string platform = stated->word({gl_platforms[0].first, gl_platforms[1].first});
    for (const auto& [name, value] : gl_platforms)
      if (name == platform) experiment.gl = value;
  }
  json.at("question").text();
  json.at("source").text();

  const auto measure_items = json.at("measures").items();
  const bool of_fields = std::any_of(measure_items.begin(), measure_items.end(),
                                     [](const JsonReader& measure) { return measure_of(measure).is_of_fields; });
  RowNames names;
  if (of_fields) {
    for (const JsonReader& field : json.at("fields").items()) {
      experiment.fields.push_back({read_name(field.at("name")), read_named_field(field, experiment.seed), field});
      add_unique(names.fields, field.at("name"), experiment.fields.back().name);
    }
    const JsonReader rays = json.at("rays");
    rays.only({"count", "length"});
    experiment.rays = {rays.at("count").integer(1, most_rays), rays.at("length").positive_number()};
    read_transfers(json, experiment);
    for (const NamedTransfer& transfer : experiment.transfers) names.transfers.push_back(transfer.name);
  } else {
    for (const char* const key : {"fields", "rays", "transfer_functions"})
      if (const auto found = json.find(key)) found->refuse_value("a measure of fields beside it, or nothing,");
  }
  std::vector<std::string> samplings;
  for (const JsonReader& item : json.at("samplings").items()) {
    experiment.samplings.push_back(read_sampling(item));
    add_unique(samplings, item,
               fmt::format("{} {}", experiment.samplings.back().kind, experiment.samplings.back().step.value_or(0)));
  }
  if (const auto schemes = json.find("schemes"))
    for (const JsonReader& scheme : schemes->items()) {
      if (is_outside_program(scheme)) {
        experiment.programs.push_back(read_program(scheme));
        add_unique(names.schemes, scheme.at("name"), experiment.programs.back().name);
        continue;
      }
      experiment.schemes.push_back(scheme.word(names_of(catalogue::integral_schemes())));
      add_unique(names.schemes, scheme, experiment.schemes.back());
    }
  if (of_fields) check_memory_of_rays(experiment);
  for (const JsonReader& measure : measure_items) {
    const Measure& found = measure_of(measure);
    add_unique(names.measures, measure.at("kind"), std::string(found.name));
    refuse_lacks(found.needs, experiment, measure);
    experiment.measures.push_back(found.ask(found, experiment, measure));
  }

  for (const Column& column : result_columns(experiment)) names.columns.push_back(column.name);
  experiment.claims = read_claims(json.at("published"), names);
  experiment.checks = read_checks(json.at("checks"), names);
  if (const auto plot = json.find("plot")) check_plot(*plot, names);
  return experiment;
}

Field make_field(const FieldSource& source, const VolumeAccess& volumes) {
  const auto make = [&] { return make_volume(source.document, volumes); };
  // What is wrong with a file names its place already.
  const bool is_generated = std::holds_alternative<GeneratedField>(source.document);
  SourcedVolume volume = is_generated ? source.json.blame_for(make) : make();
  if (volume.file.empty()) return {source.name, std::move(volume.grid), {0, 1}};
  const auto [low, high] = volume.grid.range();
  if (!std::isfinite(high - low))
    source.json.at("volume").refuse(fmt::format("values from {} to {}", low, high), "a range that binary64 holds");
  if (low < high)
    for (double& value : volume.grid.values) value = (value - low) / (high - low);
  else
    std::fill(volume.grid.values.begin(), volume.grid.values.end(), 0.0);
  return {source.name, std::move(volume.grid), {low, high}, volume.file, volume.repaired, std::move(volume.warnings)};
}

std::vector<Column> result_columns(const Experiment& experiment) {
  std::vector<Column> columns{
      {.name = "measure", .unit = "", .description = "what the row reports", .is_key = true},
      {.name = "field", .unit = "", .description = "the field that the rays cross, if any", .is_key = true},
  };
  const auto add = [&columns](const Column& added) {
    if (std::none_of(columns.begin(), columns.end(), [&](const Column& column) { return column.name == added.name; }))
      columns.push_back(added);
  };
  for (const auto& measure : experiment.measures)
    for (const Column& column : measure->columns()) add(column);
  add({.name = "status", .unit = "", .description = "ok, or refused"});
  add({.name = "why", .unit = "", .description = "why it is refused"});
  return columns;
}

}  // namespace raytruth
