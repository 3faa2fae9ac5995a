#include "study/commands.hpp"
#include "study/journal.hpp"
#include "study/measure.hpp"
#include "study/one_line.hpp"
#include "study/output.hpp"
#include "study/progress_bar.hpp"
#include "study/result.hpp"
#include "volume/find_volume.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
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
  LazyField(const Experiment& experiment, const FieldSource& source, const std::vector<std::filesystem::path>& folders)
      : experiment_(experiment), source_(source), folders_(folders) {}

  /// Null where the field's volume is absent.
  const Field* get(const ProgressBar& bar) {
    if (field_ || is_absent()) return field_ ? &*field_ : nullptr;
    try {
      field_ = make_field(experiment_, source_, folders_);
      if (!field_->warnings.empty()) bar.clear();
      for (const std::string& warning : field_->warnings) say(warning);
      return &*field_;
    } catch (const VolumeAbsent& error) {
      why_absent_ = one_line(error.what());
      bar.clear();
      say(fmt::format("warning: {}: refused: {}", source_.name, why_absent_));
      return nullptr;
    }
  }

  [[nodiscard]] bool is_absent() const { return !why_absent_.empty(); }
  [[nodiscard]] const std::string& why_absent() const { return why_absent_; }

 private:
  const Experiment& experiment_;
  const FieldSource& source_;
  const std::vector<std::filesystem::path>& folders_;
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

/// Of a measure alone.
std::int64_t blocks_of(const Measure& measure, const JsonReader& options) {
  return measure.blocks != nullptr ? measure.blocks(options) : 1;
}

/// The work of one experiment, unit by unit; a unit is a measure of one field, or a block of a measure alone.
class UnitRunner {
 public:
  UnitRunner(const Experiment& experiment, const std::vector<std::filesystem::path>& folders, Journal& journal)
      : experiment_(experiment), folders_(folders), journal_(journal), bar_(count_units(experiment)) {}

  Findings run_all() {
    for (const FieldSource& source : experiment_.fields) {
      LazyField field(experiment_, source, folders_);
      for_each_measure(true, [&](const Measure& measure, const JsonReader& options) {
        const Json part = finish(fmt::format("{}/{}", source.name, measure.name), [&]() -> std::optional<Json> {
          const Field* const made = field.get(bar_);
          if (made == nullptr) return {};
          auto rows = source.json.blame_for([&] { return measure.rows(experiment_, options, *made); });
          return Json{{"field", describe(*made)}, {"rows", rows_json(measure, source.name, std::move(rows))}};
        });
        if (part.is_null()) {
          findings_.fields[source.name] = {{"status", "refused"}, {"why", field.why_absent()}};
          findings_.rows.push_back(complete_row(measure.name, source.name, {}, field.why_absent()));
        } else {
          findings_.fields[source.name] = part.at("field");
        }
      });
    }
    for_each_measure(true,
                     [&](const Measure& measure, const JsonReader& options) { add_conclusions(measure, options); });
    for_each_measure(false, [&](const Measure& measure, const JsonReader& options) {
      for (std::int64_t block = 0; block < blocks_of(measure, options); ++block) {
        const std::string suffix = measure.blocks != nullptr ? fmt::format("/{}", block) : "";
        finish(std::string(measure.name) + suffix, [&]() -> std::optional<Json> {
          auto rows = measure.blocks != nullptr ? measure.block_rows(experiment_, options, block)
                                                : measure.rows(experiment_, options, Field{});
          return Json{{"rows", rows_json(measure, {}, std::move(rows))}};
        });
      }
    });
    return std::move(findings_);
  }

 private:
  template <class Visit>
  void for_each_measure(bool of_fields, Visit&& visit) const {
    for (const JsonReader& options : experiment_.measures) {
      const Measure& measure = measure_of(options);
      if (measure.of_fields == of_fields) visit(measure, options);
    }
  }

  static std::size_t count_units(const Experiment& experiment) {
    std::size_t count = 0;
    for (const JsonReader& options : experiment.measures) {
      const Measure& measure = measure_of(options);
      count += measure.of_fields ? experiment.fields.size() : static_cast<std::size_t>(blocks_of(measure, options));
    }
    return count;
  }

  void add_conclusions(const Measure& measure, const JsonReader& options) {
    if (measure.conclusions == nullptr) return;
    std::vector<Row> of_fields;
    std::copy_if(findings_.rows.begin(), findings_.rows.end(), std::back_inserter(of_fields),
                 [&measure](const Row& row) { return cell(row, "measure") == Value(std::string(measure.name)); });
    for (Row& row : measure.conclusions(experiment_, options, of_fields))
      findings_.rows.push_back(complete_row(measure.name, {}, std::move(row)));
  }

  /// What the unit comes to, from the journal or by doing it; null where it is refused.
  template <class Work>
  Json finish(const std::string& name, Work&& work) {
    bar_.show(name);
    const Json* const finished = journal_.find(name);
    Json part = finished != nullptr ? *finished : Json();
    if (finished == nullptr)
      if (auto done = work()) {
        part = std::move(*done);
        journal_.add(name, part);
      }
    bar_.advance(finished == nullptr);
    if (!part.is_null())
      for (const Json& row : part.at("rows"))
        findings_.rows.push_back(read_row(JsonReader::from_json(row, experiment_.json)));
    return part;
  }

  const Experiment& experiment_;
  const std::vector<std::filesystem::path>& folders_;
  Journal& journal_;
  ProgressBar bar_;
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
    return result;
  } catch (const InputError&) {
    return {};  // no result at all: to be replaced
  }
}

Json run_experiment(const Experiment& experiment, const RunOptions& options, const std::filesystem::path& file) {
  const Json run{{"raytruth", "journal/1"}, {"build", build_identity()}, {"experiment", experiment.json.json()}};
  if (options.resume)
    if (auto finished = finished_result(file, run)) return *finished;

  std::optional<GlIdentity> gl;  // before hours of work, for it may be missing
  if (uses_gl(experiment)) gl = open_gl(experiment.gl)->identity();
  const auto start = std::chrono::system_clock::now();
  const auto clock_start = std::chrono::steady_clock::now();
  Journal journal = file.empty() ? Journal() : Journal(file, run, options.resume);
  const bool is_resumed = !journal.is_empty();
  const auto folders = volume_folders(options.data);
  const Findings findings = UnitRunner(experiment, folders, journal).run_all();

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_start).count();
  const auto threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const Provenance provenance{.profile = options.profile,
                              .threads = static_cast<int>(threads),
                              .seconds = seconds,
                              .started = start,
                              .resumed = is_resumed,
                              .gl = gl};
  Json result = make_result(experiment, provenance, findings.fields, findings.rows);
  if (!file.empty()) write_whole(file, result_text(result));
  journal.remove();
  return result;
}

/// Where the result goes; empty: to standard output.
std::filesystem::path result_file(const RunOptions& options, const Experiment& experiment) {
  if (!options.folder) return {};
  return std::filesystem::path(*options.folder) / (experiment.name + ".json");
}

void refuse_overwriting(const std::string& experiment, const std::filesystem::path& result) {
  std::error_code ignored;
  if (std::filesystem::equivalent(experiment, result, ignored))
    throw InputError(
        fmt::format("{}: found the experiment where its result would go; another folder is allowed", result.string()));
}

}  // namespace

int run_experiments(const RunOptions& options) {
  if (!options.folder && options.experiments.size() > 1)
    throw InputError(fmt::format("run: found {} experiments without -o; one is allowed", options.experiments.size()));
  if (!options.folder && options.resume) throw InputError("run: found --resume without -o; -o DIR is needed with it");
  std::vector<Experiment> experiments;
  for (const std::string& path : options.experiments) {
    Experiment experiment = read_experiment(path, options.profile, options.seed, options.gl);
    for (const std::string& warning : experiment.warnings) say(warning);
    for (const Experiment& other : experiments)
      if (other.name == experiment.name) experiment.json.at("name").refuse_value("one experiment of each name");
    experiments.push_back(std::move(experiment));
  }
  for (const Experiment& experiment : experiments)
    for (const std::string& path : options.experiments) refuse_overwriting(path, result_file(options, experiment));
  if (options.folder) make_folder(*options.folder);

  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  bool all_hold = true;
  for (const Experiment& experiment : experiments) {
    const auto file = result_file(options, experiment);
    const Json result = run_experiment(experiment, options, file);
    if (file.empty()) print(result_text(result));
    fmt::print(stderr, "{}", claims_table(result.at("published")));
    for (const std::string& line : broken_checks(result)) {
      all_hold = false;
      say(line);
    }
  }
  return options.check && !all_hold ? 1 : 0;
}

}  // namespace raytruth
