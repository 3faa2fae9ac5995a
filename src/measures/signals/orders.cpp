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

namespace raytruth {

namespace {

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

std::array<LevelError, level_count> with_radius(const std::array<double, level_count>& errors, double radius) {
  std::array<LevelError, level_count> levels;
  for (std::size_t level = 0; level < level_count; ++level) levels[level] = {errors[level], radius};
  return levels;
}

}  // namespace

std::vector<Column> orders_columns(const Experiment& experiment, const JsonReader& options) {
  options.only({"kind"});
  need_signal_schemes(experiment);
  std::vector<Column> columns = convergence_columns();
  for (const auto& [name, unit] : {std::pair{"xi", "scalar*voxel"}, {"xi_max", "scalar"}}) {
    const std::string symbol = name;
    columns.push_back({.name = symbol + "_mean",
                       .unit = unit,
                       .description = symbol + ", mean over rays",
                       .is_key = false,
                       .radius = symbol + "_mean_radius"});
    columns.push_back({.name = symbol + "_mean_radius", .unit = unit, .description = "bound on its rounding error"});
    const std::vector<Column> of_order = order_columns(symbol, symbol + "_mean");
    columns.insert(columns.end(), of_order.begin(), of_order.end());
  }
  return columns;
}

std::vector<Row> orders_rows(const Experiment& experiment, const JsonReader& /*options*/, const Field& field) {
  const double radius = signal_radius * experiment.rays.length;
  std::vector<Row> rows;
  for (const auto& [regime, regime_name] : regimes)
    for (const std::string& scheme : experiment.schemes)
      catalogue::visit_scheme(scheme, [&, regime = regime, regime_name = regime_name]<class S>() {
        const Row keys{{"regime", std::string(regime_name)}, {"scheme", scheme}};
        Samples<double> samples;
        if (regime == Regime::constant) samples.step = 1;
        if (const std::string_view why = refusal<S>(samples); !why.empty()) {
          Row& row = rows.emplace_back(keys);
          row.insert(row.end(), {{"part", "fit"}, {"status", "refused"}, {"why", std::string(why)}});
          return;
        }
        const Means means = measure_means<S>(experiment, field, regime);
        for (std::size_t level = 0; level < level_count; ++level) {
          Row& row = rows.emplace_back(keys);
          row.insert(row.end(), {{"part", "point"},
                                 {"step", step_of(level)},
                                 {"xi_mean", means.xi[level]},
                                 {"xi_mean_radius", radius},
                                 {"xi_max_mean", means.xi_max[level]},
                                 {"xi_max_mean_radius", signal_radius}});
        }
        Row& row = rows.emplace_back(keys);
        row.emplace_back("part", "fit");
        add_order(row, "xi", with_radius(means.xi, radius));
        add_order(row, "xi_max", with_radius(means.xi_max, signal_radius));
      });
  return rows;
}

}  // namespace raytruth
