#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/quantile_columns.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/statistics/rank_correlation.hpp"
#include "raytruth/statistics/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace raytruth {

namespace {

/// A scheme on a ray.
struct Trial {
  double xi = 0;
  double opacity = 0;  ///< magnitudes of the errors
  double color = 0;
  double radius = 0;
};

/// Of every ray but the constant ones: by scheme.
using Trials = std::vector<std::optional<std::vector<Trial>>>;

Trials measure_trials(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer,
                      const Sampling& sampling) {
  const auto schemes = schemes_of(experiment);
  Trials trials(static_cast<std::size_t>(experiment.rays.count));
  study_rays(experiment, field, transfer, [&](const StudiedRay& ray) {
    Samples<double> samples;
    Chain<3> approximation;
    sample(ray.signal, sampling, samples);
    auto& own = trials[ray.index].emplace();
    for (const IntegralScheme* scheme : schemes) {
      const Outcome<> outcome = ray.integrate(*scheme, ray.signal, samples);
      catalogue::visit_scheme(scheme->name, [&]<class S>() { approximate<S>(ray.signal, samples, approximation); });
      own.push_back({xi(ray.signal, approximation), std::abs(outcome.opacity - ray.truth.opacity),
                     color_magnitude({outcome.color - ray.truth.color, 0}), outcome.radius + ray.truth.radius});
    }
  });
  return trials;
}

struct Quantity {
  const char* name;
  double Trial::*error;
};

constexpr std::array quantities{Quantity{"opacity", &Trial::opacity}, Quantity{"color", &Trial::color}};

struct Correlation {
  const char* name;
  std::optional<RankCorrelation> (*of)(const std::vector<double>&, const std::vector<double>&);
};

constexpr std::array correlations{Correlation{"spearman", spearman}, Correlation{"kendall", kendall}};

void add_correlation(Row& row, const std::string& name, const std::optional<RankCorrelation>& correlation) {
  row.emplace_back(name, correlation ? Value(correlation->estimate) : Value());
  row.emplace_back(name + "_low", correlation ? Value(correlation->low) : Value());
  row.emplace_back(name + "_high", correlation ? Value(correlation->high) : Value());
}

/// Whether a ray with a larger xi has a larger error.
void add_across_rays(Row& row, const Trials& trials, std::size_t scheme) {
  for (const auto& [name, error] : quantities) {
    std::vector<double> xis;
    std::vector<double> errors;
    for (const auto& ray : trials) {
      if (!ray) continue;
      xis.push_back((*ray)[scheme].xi);
      errors.push_back((*ray)[scheme].*error);
    }
    for (const auto& [correlation, of] : correlations)
      add_correlation(row, std::string(name) + "_" + correlation, of(xis, errors));
  }
}

/// Whether, on one and the same ray, the scheme with a larger xi has a larger error.
void add_across_schemes(Row& row, const Trials& trials) {
  for (const auto& [name, error] : quantities) {
    std::vector<double> taus;
    for (const auto& ray : trials) {
      if (!ray) continue;
      std::vector<double> xis;
      std::vector<double> errors;
      for (const Trial& trial : *ray) {
        xis.push_back(trial.xi);
        errors.push_back(trial.*error);
      }
      if (const auto tau = kendall(xis, errors)) taus.push_back(tau->estimate);
    }
    std::sort(taus.begin(), taus.end());
    add_quantiles(row, std::string(name) + "_schemes_kendall", taus);
  }
}

}  // namespace

std::vector<Column> xi_versus_integral_columns(const Experiment& experiment, const JsonReader& options) {
  options.only({"kind"});
  need_signal_schemes(experiment);
  need_usable_samplings(experiment, options);
  need_transfers(experiment);
  std::vector<Column> columns = transfer_columns();
  append(columns, sampling_columns());
  columns.push_back(
      {.name = "part",
       .unit = "",
       .description = "rays: one scheme, over rays; schemes: quantiles over rays of the rank correlation over schemes",
       .is_key = true});
  columns.push_back({.name = "scheme", .unit = "", .description = "the scheme, for part rays", .is_key = true});
  append(columns, count_columns());
  for (const auto& [name, error] : quantities)
    for (const auto& [correlation, of] : correlations) {
      const std::string symbol = std::string(name) + "_" + correlation;
      const std::string what = std::string(correlation) + "'s rank correlation of xi and the magnitude of the " + name +
                               "'s error, over rays";
      columns.push_back({.name = symbol, .unit = "", .description = what});
      columns.push_back({.name = symbol + "_low", .unit = "", .description = what + ": 95 % interval, low end"});
      columns.push_back({.name = symbol + "_high", .unit = "", .description = what + ": 95 % interval, high end"});
    }
  columns.push_back({.name = "radius", .unit = "", .description = "bound on the error of any of the errors"});
  for (const auto& [name, error] : quantities)
    append(columns, quantile_columns(std::string(name) + "_schemes_kendall", "",
                                     std::string("Kendall's rank correlation of xi and the magnitude of the ") + name +
                                         "'s error over the schemes, on one ray"));
  return columns;
}

std::vector<Row> xi_versus_integral_rows(const Experiment& experiment, const JsonReader& /*options*/,
                                         const Field& field) {
  std::vector<Row> rows;
  for (const NamedTransfer& transfer : experiment.transfers)
    for (const Sampling& sampling : experiment.samplings) {
      const Trials trials = measure_trials(experiment, field, transfer.transfer, sampling);
      std::size_t studied = 0;
      double radius = 0;
      for (const auto& ray : trials) {
        if (!ray) continue;
        ++studied;
        for (const Trial& trial : *ray) radius = std::max(radius, trial.radius);
      }
      Row keys = transfer_keys(experiment, transfer);
      add_sampling(keys, sampling);
      for (std::size_t scheme = 0; scheme < experiment.schemes.size(); ++scheme) {
        Row& row = rows.emplace_back(keys);
        row.insert(row.end(), {{"part", "rays"}, {"scheme", experiment.schemes[scheme]}});
        add_counts(row, experiment, studied);
        add_across_rays(row, trials, scheme);
        row.emplace_back("radius", radius);
      }
      Row& row = rows.emplace_back(keys);
      row.emplace_back("part", "schemes");
      add_counts(row, experiment, studied);
      row.emplace_back("radius", radius);
      add_across_schemes(row, trials);
    }
  return rows;
}

}  // namespace raytruth
