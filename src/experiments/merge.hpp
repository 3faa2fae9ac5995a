#pragma once

#include "experiments/units.hpp"

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <vector>

namespace raytruth {

/// Which parts are merged, and how.
struct MergeRequest {
  std::vector<std::string> places;  ///< parts, and folders of parts
  double recheck = 0;               ///< the share of units, from 0 to 1, that are done again and must come out the same
  bool mixed_cpus = false;          ///< parts of several processors are taken
  bool runs_programs = false;       ///< programs that the experiment names may run where units are done again
  bool has_times = true;            ///< the provenance says when and how long the parts ran, and on how many threads
  VolumeAccess volumes = {};        ///< of the units that are done again
};

/// A merged result, and the experiment and profile that it is of.
struct Merged {
  std::shared_ptr<const Experiment> experiment;
  std::string profile;
  nlohmann::ordered_json result;
  std::vector<std::string> parts;  ///< their files
};

/// Makes the result that one run of all units gives: the same bytes but for the times in its provenance. Parts may
/// come in any order and of any numbers of shards, and repeat each other. Throws InputError for parts of different
/// experiments, builds, profiles or processors, of another build than this program's, whose rows do not fit the
/// experiment, that contradict each other, or that do not come out again; MissingError where units are missing, with
/// the command that makes them.
Merged merge_parts(const MergeRequest& request, RunObserver& observer);

}  // namespace raytruth
