#pragma once

#include "experiments/experiment.hpp"
#include "raytruth/documents/volume_source.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// Whom a run tells how it goes on. A unit is a measure of one field, or a block of a measure without fields.
class RunObserver {
 public:
  RunObserver() = default;
  virtual ~RunObserver() = default;
  RunObserver(const RunObserver&) = delete;
  RunObserver& operator=(const RunObserver&) = delete;
  RunObserver(RunObserver&&) = delete;
  RunObserver& operator=(RunObserver&&) = delete;

  virtual void begin(std::size_t units) = 0;
  /// This unit is next.
  virtual void show(std::string_view unit) = 0;
  /// It is done; `is_worked`: by this run, not by one that was interrupted.
  virtual void advance(bool is_worked) = 0;
  /// One line for people.
  virtual void warn(std::string_view line) = 0;
};

/// How an experiment is run.
struct RunRequest {
  std::string profile = "full";  ///< of the provenance
  bool resume = false;           ///< takes what an interrupted run of the same experiment and build left
  VolumeAccess volumes = {};
};

/// Does all units of the experiment, and keeps each in a journal beside `file` until the result is there. Returns the
/// result, which it also writes to `file` unless that is empty. A volume that is absent gives a row `refused` and a
/// warning. Throws InputError, and MissingError where the experiment needs a GL that is not there.
nlohmann::ordered_json run_experiment(const Experiment& experiment, const RunRequest& request,
                                      const std::filesystem::path& file, RunObserver& observer);

}  // namespace raytruth
