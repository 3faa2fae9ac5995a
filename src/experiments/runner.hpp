#pragma once

#include "experiments/experiment.hpp"
#include "experiments/journal.hpp"
#include "experiments/units.hpp"
#include "raytruth/documents/volume_source.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace raytruth {

/// How an experiment is run.
struct RunRequest {
  std::string profile = "full";  ///< of the provenance
  bool resume = false;           ///< takes what an interrupted run of the same experiment and build left
  bool has_times = true;         ///< the provenance says when and how long it ran, and on how many threads
  VolumeAccess volumes = {};
};

/// The identity of what runs the experiment's shaders; nothing where it has none. Throws MissingError.
std::optional<GlIdentity> gl_identity(const Experiment& experiment);

/// What the units come to, in their order: from the journal, or by doing them, and then added to it.
std::vector<nlohmann::ordered_json> outcomes_of(const Experiment& experiment, std::span<const Unit> units,
                                                const VolumeAccess& volumes, Journal& journal, RunObserver& observer);

/// Does all units of the experiment, and keeps each in a journal beside `file` until the result is there. Returns the
/// result, which it also writes to `file` unless that is empty. A volume that is absent gives a row `refused` and a
/// warning. Throws InputError, and MissingError where the experiment needs a GL that is not there.
nlohmann::ordered_json run_experiment(const Experiment& experiment, const RunRequest& request,
                                      const std::filesystem::path& file, RunObserver& observer);

}  // namespace raytruth
