#include "catalogue.hpp"
#include "measures/order.hpp"
#include "measures/ray_ensemble.hpp"
#include "measures/signal_error.hpp"
#include "signals/trilinear.hpp"
#include "study/measure.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

namespace {

// Errors closer than this to what rounding makes of them take no part in a fit.
constexpr double meaningful_radii = 10;

constexpr int coarsest = 3;
constexpr int finest = 8;
constexpr std::size_t level_count = finest - coarsest + 1;

/// How samples get closer: inside every cell alike, so that no interval crosses a border, or along the whole ray.
enum class Regime { cells, constant };

struct Scratch {
  Chain<3> signal;
  Samples<double> samples;
  Chain<3> approximation;
};

/// Means over rays, by level: step 2^-(coarsest + level) of a cell or of a voxel.
struct Means {
  std::array<double, level_count> xi{};
  std::array<double, level_count> xi_max{};
};

void sample(const Chain<3>& signal, Regime regime, std::size_t level, Samples<double>& samples) {
  const int exponent = coarsest + static_cast<int>(level);
  if (regime == Regime::cells)
    sample_cells(signal, samples, 1 << exponent);
  else
    sample_constant(signal, std::ldexp(1.0, -exponent), samples);
}

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

void add_fit(Row& row, const std::string& name, const std::array<double, level_count>& errors, double radius) {
  std::vector<StepError> points;
  for (std::size_t level = 0; level < level_count; ++level)
    if (errors[level] > meaningful_radii * radius)
      points.push_back({std::ldexp(1.0, -coarsest - static_cast<int>(level)), errors[level]});
  const bool is_fit = points.size() >= 2;
  const FittedOrder fit = is_fit ? fit_order(points) : FittedOrder{};
  row.emplace_back("order_" + name, is_fit ? Value(fit.order) : Value());
  row.emplace_back("order_" + name + "_residual", is_fit ? Value(fit.residual) : Value());
  row.emplace_back("order_" + name + "_finest", is_fit ? Value(points.back().step) : Value());
}

}  // namespace

std::vector<Column> orders_columns(const Experiment& experiment, const JsonReader& options) {
  options.only({"kind"});
  need_signal_schemes(experiment);
  std::vector<Column> columns{
      {.name = "regime",
       .unit = "",
       .description = "cells: every cell divided alike, no interval crosses a border; constant: a constant step",
       .is_key = true},
      {.name = "scheme", .unit = "", .description = "the approximation", .is_key = true},
      {.name = "part", .unit = "", .description = "point: errors at one step; fit: the orders", .is_key = true},
      {.name = "step", .unit = "cell or voxel", .description = "distance of samples", .is_key = true},
  };
  for (const auto& [name, unit] : {std::pair{"xi", "scalar*voxel"}, {"xi_max", "scalar"}}) {
    const std::string symbol = name;
    columns.push_back({.name = symbol + "_mean",
                       .unit = unit,
                       .description = symbol + ", mean over rays",
                       .is_key = false,
                       .radius = symbol + "_mean_radius"});
    columns.push_back({.name = symbol + "_mean_radius", .unit = unit, .description = "bound on its rounding error"});
    columns.push_back(
        {.name = "order_" + symbol,
         .unit = "",
         .description = fmt::format("slope of log {} mean over log step, least squares over steps 2^-{} to "
                                    "2^-{}, without points within {} radii",
                                    symbol, coarsest, finest, meaningful_radii)});
    columns.push_back({.name = "order_" + symbol + "_residual",
                       .unit = "",
                       .description = "root mean square of log2 of the means about the line"});
    columns.push_back(
        {.name = "order_" + symbol + "_finest", .unit = "cell or voxel", .description = "least step in the fit"});
  }
  return columns;
}

std::vector<Row> orders_rows(const Experiment& experiment, const JsonReader& /*options*/, const Field& field) {
  const double radius = signal_radius * experiment.rays.length;
  std::vector<Row> rows;
  for (const auto& [regime, regime_name] : {std::pair{Regime::cells, "cells"}, {Regime::constant, "constant"}})
    for (const std::string& scheme : experiment.schemes)
      catalogue::visit_scheme(scheme, [&, regime = regime, regime_name = regime_name]<class S>() {
        const Row keys{{"regime", regime_name}, {"scheme", scheme}};
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
                                 {"step", std::ldexp(1.0, -coarsest - static_cast<int>(level))},
                                 {"xi_mean", means.xi[level]},
                                 {"xi_mean_radius", radius},
                                 {"xi_max_mean", means.xi_max[level]},
                                 {"xi_max_mean_radius", signal_radius}});
        }
        Row& row = rows.emplace_back(keys);
        row.emplace_back("part", "fit");
        add_fit(row, "xi", means.xi, radius);
        add_fit(row, "xi_max", means.xi_max, signal_radius);
      });
  return rows;
}

}  // namespace raytruth
