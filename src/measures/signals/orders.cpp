#include "experiments/measure.hpp"
#include "measures/convergence.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

struct Scratch {
  Chain<3> signal;
  Samples<double> samples;
  Chain<3> approximation;
};

/// Means over rays, by level.
struct Means {
  std::array<double, level_count> xi{};
  std::array<double, level_count> xi_max{};
};

/// Each ray writes to a place of its own; the sums are taken in the rays' order.
template <Scheme S>
Means measure_means(const Experiment& experiment, const Field& field, Regime regime) {
  std::vector<Means> rays(static_cast<std::size_t>(experiment.rays.count));
  tbb::enumerable_thread_specific<Scratch> scratches;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
    auto& [signal, samples, approximation] = scratches.local();
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray) {
      trace_trilinear(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray), signal);
      for (std::size_t level = 0; level < level_count; ++level) {
        sample(signal, regime, level, samples);
        approximate<S>(signal, samples, approximation);
        rays[ray].xi[level] = xi(signal, approximation);
        rays[ray].xi_max[level] = xi_max(signal, approximation);
      }
    }
  });
  Means means;
  for (const Means& ray : rays)
    for (std::size_t level = 0; level < level_count; ++level) {
      means.xi[level] += ray.xi[level] / static_cast<double>(rays.size());
      means.xi_max[level] += ray.xi_max[level] / static_cast<double>(rays.size());
    }
  return means;
}

ShownOrder order_of(const std::array<double, level_count>& errors, double radius) {
  std::array<LevelError, level_count> levels;
  for (std::size_t level = 0; level < level_count; ++level) levels[level] = {errors[level], radius};
  return shown_order(levels);
}

/// xi or xi_max: at a step, or the order that all steps show.
struct Finding {
  std::optional<LevelError> mean = {};
  std::optional<ShownOrder> order = {};
};

struct Record {
  ConvergenceKeys keys;
  Finding xi = {};
  Finding xi_max = {};
  std::optional<std::string> refusal = {};
};

Columns<Finding> finding_columns(const std::string& symbol, const std::string& unit) {
  Columns<Finding> columns;
  append_part(columns, &Finding::mean,
              Columns<LevelError>{{.name = symbol + "_mean",
                                   .unit = unit,
                                   .description = symbol + ", mean over rays",
                                   .radius = symbol + "_mean_radius",
                                   .cell = &LevelError::error},
                                  {.name = symbol + "_mean_radius",
                                   .unit = unit,
                                   .description = "bound on its rounding error",
                                   .cell = &LevelError::radius}});
  append_part(columns, &Finding::order, shown_order_columns(symbol, symbol + "_mean"));
  return columns;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::keys, convergence_key_columns());
  append_part(columns, &Record::xi, finding_columns("xi", "scalar*voxel"));
  append_part(columns, &Record::xi_max, finding_columns("xi_max", "scalar"));
  append_refusal(columns, &Record::refusal);
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  const double radius = signal_radius * experiment.rays.length;
  std::vector<Record> records;
  for (const auto& [regime, regime_name] : regimes)
    for (const std::string& scheme : experiment.schemes)
      catalogue::visit_scheme(scheme, [&, regime = regime, regime_name = regime_name]<class S>() {
        const auto keys = [&](std::optional<double> step) {
          return ConvergenceKeys{.regime = std::string(regime_name), .scheme = scheme, .step = step};
        };
        Samples<double> samples;
        if (regime == Regime::constant) samples.step = 1;
        if (const std::string_view why = refusal<S>(samples); !why.empty()) {
          records.push_back({.keys = keys({}), .refusal = std::string(why)});
          return;
        }
        const Means means = measure_means<S>(experiment, field, regime);
        for (std::size_t level = 0; level < level_count; ++level)
          records.push_back({.keys = keys(step_of(level)),
                             .xi = {.mean = LevelError{means.xi[level], radius}},
                             .xi_max = {.mean = LevelError{means.xi_max[level], signal_radius}}});
        records.push_back({.keys = keys({}),
                           .xi = {.order = order_of(means.xi, radius)},
                           .xi_max = {.order = order_of(means.xi_max, signal_radius)}});
      });
  return records;
}

}  // namespace

extern const Measure orders_measure;
const Measure orders_measure{MeasureDefinition<Options, Record>{
    .name = "orders",
    .summary = "fitted orders of xi and xi_max, refined inside cells and at constant steps across them",
    .needs = {.signal_schemes = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
