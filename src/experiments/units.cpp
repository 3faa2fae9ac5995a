#include "experiments/units.hpp"

#include "experiments/measure.hpp"
#include "experiments/result.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

/// The row with its keys in front, and its status behind where the measure gave it none.
Row complete_row(std::string_view measure, const std::string& field, Row row, const std::string& why = {}) {
  const bool has_status = cell(row, "status") != Value();
  Row complete{{"measure", std::string(measure)}, {"field", field.empty() ? Value() : Value(field)}};
  complete.insert(complete.end(), std::make_move_iterator(row.begin()), std::make_move_iterator(row.end()));
  if (has_status) return complete;
  complete.emplace_back("status", why.empty() ? "ok" : "refused");
  complete.emplace_back("why", why.empty() ? Value() : Value(why));
  return complete;
}

Json rows_json(const Measure& measure, const std::string& field, std::vector<Row> rows) {
  Json json = Json::array();
  for (Row& row : rows) json.push_back(to_json(complete_row(measure.name, field, std::move(row))));
  return json;
}

std::string name_of_block(const AskedMeasure& measure, std::int64_t block) {
  const std::string_view name = measure.measure().name;
  return measure.blocks() == 1 ? std::string(name) : fmt::format("{}/{}", name, block);
}

void add_conclusions(const Experiment& experiment, const AskedMeasure& measure, std::vector<Row>& rows) {
  const std::string_view name = measure.measure().name;
  std::vector<Row> of_fields;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(of_fields),
               [name](const Row& row) { return cell(row, "measure") == Value(std::string(name)); });
  for (Row& row : measure.conclusions(experiment, of_fields)) rows.push_back(complete_row(name, {}, std::move(row)));
}

}  // namespace

/// A field, made when it is first asked for: an interrupted run may have finished with it.
class UnitWorker::LazyField {
 public:
  LazyField(const FieldSource& source, const VolumeAccess& volumes) : source_(source), volumes_(volumes) {}

  [[nodiscard]] bool is_of(const FieldSource& source) const { return &source == &source_; }

  /// Null where the field's volume is absent.
  const Field* get(RunObserver& observer) {
    if (field_ || !why_absent_.empty()) return field_ ? &*field_ : nullptr;
    try {
      field_ = make_field(source_, volumes_);
      for (const std::string& warning : field_->warnings) observer.warn(warning);
      return &*field_;
    } catch (const VolumeAbsent& error) {
      why_absent_ = one_line(error.why);
      observer.warn(fmt::format("warning: {}: refused: {}", source_.name, error.what()));
      return nullptr;
    }
  }

  [[nodiscard]] const std::string& why_absent() const { return why_absent_; }

 private:
  const FieldSource& source_;
  const VolumeAccess& volumes_;
  std::optional<Field> field_;
  std::string why_absent_;
};

std::vector<Unit> units_of(const Experiment& experiment) {
  std::vector<Unit> units;
  for (const FieldSource& field : experiment.fields)
    for (const auto& measure : experiment.measures)
      if (measure->measure().is_of_fields)
        units.push_back({fmt::format("{}/{}", field.name, measure->measure().name), measure.get(), &field, 0});
  for (const auto& measure : experiment.measures)
    if (!measure->measure().is_of_fields)
      for (std::int64_t block = 0; block < measure->blocks(); ++block)
        units.push_back({name_of_block(*measure, block), measure.get(), nullptr, block});
  return units;
}

UnitWorker::UnitWorker(const Experiment& experiment, const VolumeAccess& volumes, RunObserver& observer)
    : experiment_(experiment), volumes_(volumes), observer_(observer) {}

UnitWorker::~UnitWorker() = default;

Json UnitWorker::work(const Unit& unit) {
  const auto start = std::chrono::steady_clock::now();
  const Measure& measure = unit.measure->measure();
  Json outcome{{"seconds", 0}};
  if (unit.field == nullptr) {
    outcome["rows"] = rows_json(measure, {}, unit.measure->rows(experiment_, {}, unit.block));
  } else {
    const FieldSource& source = *unit.field;
    if (!field_ || !field_->is_of(source)) field_ = std::make_unique<LazyField>(source, volumes_);
    if (const Field* const field = field_->get(observer_)) {
      auto rows = source.json.blame_for([&] { return unit.measure->rows(experiment_, *field, unit.block); });
      outcome["field"] = describe(*field);
      outcome["rows"] = rows_json(measure, source.name, std::move(rows));
    } else {
      outcome["refused"] = field_->why_absent();
    }
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome["seconds"] = std::round(seconds * 1000) / 1000;
  return outcome;
}

bool is_refused(const Json& outcome) { return outcome.contains("refused"); }

Findings findings_of(const Experiment& experiment, const std::vector<Unit>& units, const std::vector<Json>& outcomes) {
  Findings findings;
  const auto add = [&](const Unit& unit, const Json& outcome) {
    if (is_refused(outcome)) {
      const auto why = outcome.at("refused").get<std::string>();
      findings.fields[unit.field->name] = {{"status", "refused"}, {"why", why}};
      findings.rows.push_back(complete_row(unit.measure->measure().name, unit.field->name, {}, why));
      return;
    }
    if (unit.field != nullptr) findings.fields[unit.field->name] = outcome.at("field");
    for (const Json& row : outcome.at("rows"))
      findings.rows.push_back(read_row(JsonReader::from_json(row, experiment.json)));
  };
  std::size_t i = 0;
  for (; i < units.size() && units[i].field != nullptr; ++i) add(units[i], outcomes[i]);
  for (const auto& measure : experiment.measures)
    if (measure->measure().is_of_fields) add_conclusions(experiment, *measure, findings.rows);
  for (; i < units.size(); ++i) add(units[i], outcomes[i]);
  return findings;
}

}  // namespace raytruth
