#include "measures/ray_study.hpp"

#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace raytruth {

namespace {

/// What a thread holds for its rays.
struct Worker {
  RayIntegral truth;
  SchemeIntegral integrate;
  Chain<3> signal;
};

}  // namespace

void study_rays(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer,
                const std::function<void(const StudiedRay&)>& work) {
  const auto count = static_cast<std::size_t>(experiment.rays.count);
  tbb::enumerable_thread_specific<Worker> workers([&] {
    return Worker{RayIntegral(transfer, experiment.emission), SchemeIntegral(transfer, experiment.emission), {}};
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    auto& [integrate_truth, integrate, signal] = workers.local();
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray) {
      trace_trilinear(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray), signal);
      if (!signal.is_constant()) work({ray, signal, integrate_truth(signal), integrate});
    }
  });
}

void sample(const Chain<3>& signal, const Sampling& sampling, Samples<double>& samples) {
  if (sampling.step)
    sample_constant(signal, *sampling.step, samples);
  else
    sample_cells(signal, samples);
}

std::vector<const IntegralScheme*> schemes_of(const Experiment& experiment) {
  std::vector<const IntegralScheme*> schemes;
  schemes.reserve(experiment.schemes.size());
  for (const std::string& name : experiment.schemes) schemes.push_back(find_named(catalogue::integral_schemes(), name));
  return schemes;
}

std::string emission_name(Emission emission) { return emission == Emission::associated ? "associated" : "plain"; }

Columns<TransferKeys> transfer_key_columns() {
  return {{.name = "transfer", .description = "the transfer function", .is_key = true, .cell = &TransferKeys::transfer},
          {.name = "emission",
           .description = "associated: q = extinction times color; plain: q = color",
           .is_key = true,
           .cell = [](const TransferKeys& keys) { return emission_name(keys.emission); }}};
}

Columns<Sampling> sampling_key_columns() {
  return {{.name = "sampling", .description = "where samples are taken", .is_key = true, .cell = &Sampling::kind},
          {.name = "step",
           .unit = "voxel",
           .description = "distance of samples, constant sampling only",
           .is_key = true,
           .cell = &Sampling::step}};
}

RayCounts ray_counts(const Experiment& experiment, std::size_t studied) {
  return {experiment.rays.count, experiment.rays.count - static_cast<std::int64_t>(studied)};
}

Columns<RayCounts> ray_count_columns() {
  return {{.name = "rays", .description = "rays drawn", .cell = &RayCounts::drawn},
          {.name = "rays_constant",
           .description = "of these, rays with a constant signal, left out",
           .cell = &RayCounts::constant}};
}

}  // namespace raytruth
