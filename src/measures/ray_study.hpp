#pragma once

#include "experiments/columns.hpp"
#include "experiments/experiment.hpp"
#include "raytruth/core/chain.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace raytruth {

/// A ray of an experiment under one of its transfer functions.
struct StudiedRay {
  std::size_t index;
  const Chain<3>& signal;
  const Certified& truth;     ///< of this chain of cubics, which is the signal
  SchemeIntegral& integrate;  ///< under the same transfer function
};

/// Calls work(ray) for every ray of the experiment through the field whose signal is not constant, in parallel: it
/// writes to places of the ray's own.
void study_rays(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer,
                const std::function<void(const StudiedRay&)>& work);

/// Samples of the signal as the experiment asks for.
void sample(const Chain<3>& signal, const Sampling& sampling, Samples<double>& samples);

/// The experiment's schemes in the catalogue.
std::vector<const IntegralScheme*> schemes_of(const Experiment& experiment);

/// "associated" or "plain".
std::string emission_name(Emission emission);

/// Under which transfer function colour and opacity are studied.
struct TransferKeys {
  std::string transfer;
  Emission emission;
};

/// Keys of the rows: `transfer`, `emission`.
Columns<TransferKeys> transfer_key_columns();

/// More keys: `sampling`, `step`.
Columns<Sampling> sampling_key_columns();

/// How many rays there were.
struct RayCounts {
  std::int64_t drawn = 0;
  std::int64_t constant = 0;  ///< of these, with a constant signal: not studied
};

RayCounts ray_counts(const Experiment& experiment, std::size_t studied);

/// `rays`, `rays_constant`.
Columns<RayCounts> ray_count_columns();

}  // namespace raytruth
