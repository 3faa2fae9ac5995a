#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/quantile_columns.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/statistics/rank_correlation.hpp"
#include "raytruth/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

/// A scheme on a ray.
struct Trial {
  double xi = 0;
  double opacity = 0;  ///< magnitudes of the errors
  double color = 0;
  double radius = 0;
};

/// What every ray but the constant ones gives, by scheme.
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

/// Two correlations of ranks; each none where it is not defined.
struct Correlations {
  std::optional<RankCorrelation> spearman;
  std::optional<RankCorrelation> kendall;
};

/// Whether a ray with a larger xi has a larger error.
Correlations across_rays(const Trials& trials, std::size_t scheme, double Trial::*error) {
  std::vector<double> xis;
  std::vector<double> errors;
  for (const auto& ray : trials) {
    if (!ray) continue;
    xis.push_back((*ray)[scheme].xi);
    errors.push_back((*ray)[scheme].*error);
  }
  return {spearman(xis, errors), kendall(xis, errors)};
}

/// Whether, on one and the same ray, the scheme with a larger xi has a larger error: Kendall's correlation over the
/// schemes, of all rays.
ShownQuantiles across_schemes(const Trials& trials, double Trial::*error) {
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
  return shown_quantiles(taus);
}

struct AcrossRays {
  std::string scheme;
  Correlations opacity;
  Correlations color;
};

struct AcrossSchemes {
  ShownQuantiles opacity;
  ShownQuantiles color;
};

/// One of the two is there.
struct Record {
  TransferKeys transfer;
  Sampling sampling;
  RayCounts rays;
  std::optional<AcrossRays> across_rays = {};
  double radius = 0;
  std::optional<AcrossSchemes> across_schemes = {};
};

/// NAME and the ends of its interval.
Columns<std::optional<RankCorrelation>> correlation_columns(const std::string& name, const std::string& description) {
  const auto column = [&](const std::string& suffix, double RankCorrelation::*figure, const std::string& which) {
    return RecordColumn<std::optional<RankCorrelation>>{
        .name = name + suffix,
        .description = description + which,
        .cell = [figure](const std::optional<RankCorrelation>& correlation) {
          return correlation ? std::optional((*correlation).*figure) : std::nullopt;
        }};
  };
  return {column("", &RankCorrelation::estimate, ""), column("_low", &RankCorrelation::low, ": 95 % interval, low end"),
          column("_high", &RankCorrelation::high, ": 95 % interval, high end")};
}

/// Columns of the correlations of xi and the errors of colour or opacity, `quantity`.
Columns<Correlations> correlations_columns(const std::string& quantity) {
  Columns<Correlations> columns;
  for (const auto& [name, correlation] :
       {std::pair{"spearman", &Correlations::spearman}, {"kendall", &Correlations::kendall}})
    append_part(columns, correlation,
                correlation_columns(quantity + "_" + name, std::string(name) +
                                                               "'s rank correlation of xi and the magnitude of the " +
                                                               quantity + "'s error, over rays"));
  return columns;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::transfer, transfer_key_columns());
  append_part(columns, &Record::sampling, sampling_key_columns());
  columns.push_back(
      {.name = "part",
       .description = "rays: one scheme, over rays; schemes: quantiles over rays of the rank correlation over schemes",
       .is_key = true,
       .cell = [](const Record& record) { return record.across_rays ? "rays" : "schemes"; }});
  append_part(
      columns, &Record::across_rays,
      Columns<AcrossRays>{
          {.name = "scheme", .description = "the scheme, for part rays", .is_key = true, .cell = &AcrossRays::scheme}});
  append_part(columns, &Record::rays, ray_count_columns());
  Columns<AcrossRays> of_rays;
  append_part(of_rays, &AcrossRays::opacity, correlations_columns("opacity"));
  append_part(of_rays, &AcrossRays::color, correlations_columns("color"));
  append_part(columns, &Record::across_rays, of_rays);
  columns.push_back(
      {.name = "radius", .description = "bound on the error of any of the errors", .cell = &Record::radius});
  Columns<AcrossSchemes> of_schemes;
  for (const auto& [name, quantiles] :
       {std::pair{"opacity", &AcrossSchemes::opacity}, {"color", &AcrossSchemes::color}})
    append_part(of_schemes, quantiles,
                shown_quantile_columns(std::string(name) + "_schemes_kendall", "",
                                       std::string("Kendall's rank correlation of xi and the magnitude of the ") +
                                           name + "'s error over the schemes, on one ray"));
  append_part(columns, &Record::across_schemes, of_schemes);
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  std::vector<Record> records;
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
      const Record known{.transfer = {transfer.name, experiment.emission},
                         .sampling = sampling,
                         .rays = ray_counts(experiment, studied),
                         .radius = radius};
      for (std::size_t scheme = 0; scheme < experiment.schemes.size(); ++scheme)
        records.emplace_back(known).across_rays = {.scheme = experiment.schemes[scheme],
                                                   .opacity = across_rays(trials, scheme, &Trial::opacity),
                                                   .color = across_rays(trials, scheme, &Trial::color)};
      records.emplace_back(known).across_schemes = {.opacity = across_schemes(trials, &Trial::opacity),
                                                    .color = across_schemes(trials, &Trial::color)};
    }
  return records;
}

}  // namespace

extern const Measure xi_versus_integral_measure;
const Measure xi_versus_integral_measure{
    MeasureDefinition<Options, Record>{.name = "xi_versus_integral",
                                       .summary = "rank correlation of xi and the errors of colour and opacity",
                                       .needs = {.signal_schemes = true, .usable_samplings = true, .transfers = true},
                                       .read = read_options,
                                       .columns = columns,
                                       .of_field = records_of_field}};

}  // namespace raytruth
