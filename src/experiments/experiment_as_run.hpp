#pragma once

#include "experiments/experiment.hpp"

namespace raytruth {

/// Reads and checks an experiment as results hold it: a profile is merged in, defaults are filled in. Throws
/// InputError.
Experiment read_experiment_as_run(const JsonReader& json);

}  // namespace raytruth
