#include "experiments/runner.hpp"

#include "experiments/output.hpp"
#include "experiments/result.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <system_error>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

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

std::optional<GlIdentity> gl_identity(const Experiment& experiment) {
  if (!uses_gl(experiment)) return {};
  return open_gl(experiment.gl)->identity();
}

std::vector<Json> outcomes_of(const Experiment& experiment, std::span<const Unit> units, const VolumeAccess& volumes,
                              Journal& journal, RunObserver& observer) {
  UnitWorker worker(experiment, volumes, observer);
  std::vector<Json> outcomes;
  outcomes.reserve(units.size());
  observer.begin(units.size());
  for (const Unit& unit : units) {
    observer.show(unit.name);
    const Json* const finished = journal.find(unit.name);
    outcomes.push_back(finished != nullptr ? *finished : worker.work(unit));
    if (finished == nullptr && !is_refused(outcomes.back())) journal.add(unit.name, outcomes.back());
    observer.advance(finished == nullptr);
  }
  return outcomes;
}

Json run_experiment(const Experiment& experiment, const RunRequest& request, const std::filesystem::path& file,
                    RunObserver& observer) {
  Json run{{"raytruth", "journal/1"}, {"build", build_identity()}, {"experiment", experiment.json.json()}};
  if (experiment.runs_programs) run["programs"] = true;
  if (request.resume)
    if (auto finished = finished_result(file, run)) return *finished;

  const auto gl = gl_identity(experiment);  // before hours of work, for it may be missing
  const auto start = std::chrono::system_clock::now();
  const auto clock_start = std::chrono::steady_clock::now();
  Journal journal = file.empty() ? Journal() : Journal(file, run, request.resume);
  const bool is_resumed = !journal.is_empty();
  const auto units = units_of(experiment);
  const auto outcomes = outcomes_of(experiment, units, request.volumes, journal, observer);
  const Findings findings = findings_of(experiment, units, outcomes);

  Provenance provenance{.profile = request.profile, .gl = gl, .programs = experiment.runs_programs};
  if (request.has_times)
    provenance.times =
        RunTimes{.threads = threads_in_use(),
                 .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_start).count(),
                 .started = utc_text(start),
                 .resumed = is_resumed};
  Json result = make_result(experiment, provenance, findings.fields, findings.rows);
  if (!file.empty()) write_whole(file, result_text(result));
  journal.remove();
  return result;
}

}  // namespace raytruth
