#include "experiments/runner.hpp"

#include "experiments/journal.hpp"
#include "experiments/measure.hpp"
#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <iterator>

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

/// A field, made when it is first asked for: an interrupted run may have finished with it.
class LazyField {
 public:
  LazyField(const FieldSource& source, const VolumeAccess& volumes) : source_(source), volumes_(volumes) {}

  /// Null where the field's volume is absent.
  const Field* get(RunObserver& observer) {
    if (field_ || is_absent()) return field_ ? &*field_ : nullptr;
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

  [[nodiscard]] bool is_absent() const { return !why_absent_.empty(); }
  [[nodiscard]] const std::string& why_absent() const { return why_absent_; }

 private:
  const FieldSource& source_;
  const VolumeAccess& volumes_;
  std::optional<Field> field_;
  std::string why_absent_;
};

/// What the rows and facts of all fields come to.
struct Findings {
  Json fields = Json::object();
  std::vector<Row> rows;
};

Json rows_json(const Measure& measure, const std::string& field, std::vector<Row> rows) {
  Json json = Json::array();
  for (Row& row : rows) json.push_back(to_json(complete_row(measure.name, field, std::move(row))));
  return json;
}

/// The work of one experiment, unit by unit; a unit is a measure of one field, or a block of a measure alone.
class UnitRunner {
 public:
  UnitRunner(const Experiment& experiment, const VolumeAccess& volumes, Journal& journal, RunObserver& observer)
      : experiment_(experiment), volumes_(volumes), journal_(journal), observer_(observer) {
    observer_.begin(count_units(experiment));
  }

  Findings run_all() {
    for (const FieldSource& source : experiment_.fields) {
      LazyField field(source, volumes_);
      for_each_measure(true, [&](const AskedMeasure& asked) { run_field(asked, source, field); });
    }
    for_each_measure(true, [&](const AskedMeasure& asked) { add_conclusions(asked); });
    for_each_measure(false, [&](const AskedMeasure& asked) {
      const std::string_view name = asked.measure().name;
      const std::int64_t blocks = asked.blocks();
      for (std::int64_t block = 0; block < blocks; ++block)
        finish(blocks == 1 ? std::string(name) : fmt::format("{}/{}", name, block), [&]() -> std::optional<Json> {
          return Json{{"rows", rows_json(asked.measure(), {}, asked.rows(experiment_, {}, block))}};
        });
    });
    return std::move(findings_);
  }

 private:
  template <class Visit>
  void for_each_measure(bool is_of_fields, Visit&& visit) const {
    for (const auto& asked : experiment_.measures)
      if (asked->measure().is_of_fields == is_of_fields) visit(*asked);
  }

  static std::size_t count_units(const Experiment& experiment) {
    std::size_t count = 0;
    for (const auto& asked : experiment.measures)
      count += asked->measure().is_of_fields ? experiment.fields.size() : static_cast<std::size_t>(asked->blocks());
    return count;
  }

  void run_field(const AskedMeasure& asked, const FieldSource& source, LazyField& field) {
    const Measure& measure = asked.measure();
    const Json part = finish(fmt::format("{}/{}", source.name, measure.name), [&]() -> std::optional<Json> {
      const Field* const made = field.get(observer_);
      if (made == nullptr) return {};
      auto rows = source.json.blame_for([&] { return asked.rows(experiment_, *made, 0); });
      return Json{{"field", describe(*made)}, {"rows", rows_json(measure, source.name, std::move(rows))}};
    });
    if (part.is_null()) {
      findings_.fields[source.name] = {{"status", "refused"}, {"why", field.why_absent()}};
      findings_.rows.push_back(complete_row(measure.name, source.name, {}, field.why_absent()));
    } else {
      findings_.fields[source.name] = part.at("field");
    }
  }

  void add_conclusions(const AskedMeasure& asked) {
    const std::string_view name = asked.measure().name;
    std::vector<Row> of_fields;
    std::copy_if(findings_.rows.begin(), findings_.rows.end(), std::back_inserter(of_fields),
                 [name](const Row& row) { return cell(row, "measure") == Value(std::string(name)); });
    for (Row& row : asked.conclusions(experiment_, of_fields))
      findings_.rows.push_back(complete_row(name, {}, std::move(row)));
  }

  /// What the unit comes to, from the journal or by doing it; null where it is refused.
  template <class Work>
  Json finish(const std::string& name, Work&& work) {
    observer_.show(name);
    const Json* const finished = journal_.find(name);
    Json part = finished != nullptr ? *finished : Json();
    if (finished == nullptr)
      if (auto done = work()) {
        part = std::move(*done);
        journal_.add(name, part);
      }
    observer_.advance(finished == nullptr);
    if (!part.is_null())
      for (const Json& row : part.at("rows"))
        findings_.rows.push_back(read_row(JsonReader::from_json(row, experiment_.json)));
    return part;
  }

  const Experiment& experiment_;
  const VolumeAccess& volumes_;
  Journal& journal_;
  RunObserver& observer_;
  Findings findings_;
};

/// The result that is there already, if it is of this very run.
std::optional<Json> finished_result(const std::filesystem::path& file, const Json& run) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return {};
  try {
    Json result = read_result(file.string()).json();
    const Json& origin = result.at("provenance");
    for (const auto& [key, value] : run.at("build").items())
      if (!origin.contains(key) || origin.at(key) != value) return {};
    if (result.at("experiment") != run.at("experiment")) return {};
    if (origin.contains("programs") != run.contains("programs")) return {};
    return result;
  } catch (const InputError&) {
    return {};  // no result at all: to be replaced
  }
}

}  // namespace

Json run_experiment(const Experiment& experiment, const RunRequest& request, const std::filesystem::path& file,
                    RunObserver& observer) {
  Json run{{"raytruth", "journal/1"}, {"build", build_identity()}, {"experiment", experiment.json.json()}};
  if (experiment.runs_programs) run["programs"] = true;
  if (request.resume)
    if (auto finished = finished_result(file, run)) return *finished;

  std::optional<GlIdentity> gl;  // before hours of work, for it may be missing
  if (uses_gl(experiment)) gl = open_gl(experiment.gl)->identity();
  const auto start = std::chrono::system_clock::now();
  const auto clock_start = std::chrono::steady_clock::now();
  Journal journal = file.empty() ? Journal() : Journal(file, run, request.resume);
  const bool is_resumed = !journal.is_empty();
  const Findings findings = UnitRunner(experiment, request.volumes, journal, observer).run_all();

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_start).count();
  const auto threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const Provenance provenance{.profile = request.profile,
                              .threads = static_cast<int>(threads),
                              .seconds = seconds,
                              .started = start,
                              .resumed = is_resumed,
                              .gl = gl,
                              .programs = experiment.runs_programs};
  Json result = make_result(experiment, provenance, findings.fields, findings.rows);
  if (!file.empty()) write_whole(file, result_text(result));
  journal.remove();
  return result;
}

}  // namespace raytruth
