#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/statistics/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_iterations = 65536;

struct Options {
  std::string signal;
  std::vector<std::int64_t> counts;  ///< ascending
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "signal", "counts"});
  Options options{json.at("signal").word({"order1", "order2"}), {}};
  for (const JsonReader& count : json.at("counts").items()) {
    const std::int64_t least = options.counts.empty() ? 1 : options.counts.back() + 1;
    options.counts.push_back(count.integer(least, most_iterations));
  }
  return options;
}

IntegralScheme scheme_of(const std::string& signal, std::int64_t count, bool is_left) {
  IntegralScheme scheme;
  scheme.method = Iterations{static_cast<int>(count), is_left};
  scheme.signal = signal;
  return scheme;
}

/// Three channels and the opacity as an 8-bit frame holds them.
using Pixel = std::array<int, 4>;

Pixel pixel_of(const Vector3<double>& color, double opacity) {
  const auto quantized = [](double x) { return static_cast<int>(std::lround(255 * std::clamp(x, 0.0, 1.0))); };
  return {quantized(color[0]), quantized(color[1]), quantized(color[2]), quantized(opacity)};
}

int largest_step(const Pixel& a, const Pixel& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// A ray with some number of iterations, against the exact integral of the same slabs.
struct Trial {
  Difference error;
  double radius = 0;
  int pixel_steps = 0;  ///< largest difference of 8-bit values
};

/// The errors of every ray but the constant ones, by count.
using Trials = std::vector<std::optional<std::vector<Trial>>>;

Trials measure_trials(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer,
                      const Sampling& sampling, const Options& options, bool is_left) {
  Trials trials(static_cast<std::size_t>(experiment.rays.count));
  study_rays(experiment, field, transfer, [&](const StudiedRay& ray) {
    Samples<double> samples;
    sample(ray.signal, sampling, samples);
    auto& own = trials[ray.index].emplace();
    for (const std::int64_t count : options.counts) {
      const ErrorBudget budget =
          ray.integrate.budget(scheme_of(options.signal, count, is_left), ray.signal, samples, ray.truth);
      const Difference& error = budget.quadrature;
      const Outcome<>& outcome = budget.outcome;
      own.push_back({error, budget.radius,
                     largest_step(pixel_of(outcome.color, outcome.opacity),
                                  pixel_of(outcome.color - error.color, outcome.opacity - error.opacity))});
    }
  });
  return trials;
}

/// The share of rays on which `holds` of their trials.
template <class Holds>
double share(const Trials& trials, Holds&& holds) {
  double hits = 0;
  double rays = 0;
  for (const auto& ray : trials) {
    if (!ray) continue;
    rays += 1;
    hits += holds(*ray) ? 1 : 0;
  }
  return rays > 0 ? hits / rays : 0;
}

/// Whether the 8-bit result is the exact one with this count and all larger ones.
bool is_settled(const std::vector<Trial>& ray, std::size_t from) {
  return std::all_of(ray.begin() + static_cast<std::ptrdiff_t>(from), ray.end(),
                     [](const Trial& trial) { return trial.pixel_steps == 0; });
}

struct Record {
  TransferKeys transfer;
  Sampling sampling;
  std::string signal;
  std::string_view variant;
  std::int64_t iterations = 0;
  RayCounts rays;
  ErrorSummary errors;
  double unchanged_share = 0;
  double within_one_share = 0;
  double settled_share = 0;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::transfer, transfer_key_columns());
  append_part(columns, &Record::sampling, sampling_key_columns());
  append(columns,
         {{.name = "signal",
           .description = "the scheme whose slabs are integrated",
           .is_key = true,
           .cell = &Record::signal},
          {.name = "variant",
           .description = "where an iteration looks the transfer function up: mid: (k + 1/2)/N, left: k/N",
           .is_key = true,
           .cell = &Record::variant},
          {.name = "iterations", .description = "N, of each slab", .is_key = true, .cell = &Record::iterations}});
  append_part(columns, &Record::rays, ray_count_columns());
  append_part(columns, &Record::errors,
              error_summary_columns("1/255", "a ray minus the exact integral of the same slabs"));
  append(columns, {{.name = "unchanged_share",
                    .description = "rays whose colour and opacity in 8 bits are those of the exact integral",
                    .cell = &Record::unchanged_share},
                   {.name = "within_one_share",
                    .description = "rays on which none of the four is off by more than 1",
                    .cell = &Record::within_one_share},
                   {.name = "settled_share",
                    .description = "rays that are unchanged with this N and all larger ones of the study",
                    .cell = &Record::settled_share}});
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  std::vector<Record> records;
  for (const NamedTransfer& transfer : experiment.transfers)
    for (const Sampling& sampling : experiment.samplings)
      for (const auto& [variant, is_left] : {std::pair{"mid", false}, {"left", true}}) {
        const Trials trials = measure_trials(experiment, field, transfer.transfer, sampling, options, is_left);
        for (std::size_t count = 0; count < options.counts.size(); ++count) {
          RayErrors errors;
          for (const auto& ray : trials)
            if (ray) errors.add((*ray)[count].error, (*ray)[count].radius);
          const auto within = [count](int steps) {
            return [count, steps](const std::vector<Trial>& ray) { return ray[count].pixel_steps <= steps; };
          };
          const auto settled = [count](const std::vector<Trial>& ray) { return is_settled(ray, count); };
          records.push_back({.transfer = {transfer.name, experiment.emission},
                             .sampling = sampling,
                             .signal = options.signal,
                             .variant = variant,
                             .iterations = options.counts[count],
                             .rays = ray_counts(experiment, errors.rays.size()),
                             .errors = summary_of(errors, 255),
                             .unchanged_share = share(trials, within(0)),
                             .within_one_share = share(trials, within(1)),
                             .settled_share = share(trials, settled)});
        }
      }
  return records;
}

}  // namespace

extern const Measure iterations_measure;
const Measure iterations_measure{MeasureDefinition<Options, Record>{
    .name = "iterations",
    .summary = "errors of slabs that are summed up in N iterations, in steps of an 8-bit frame",
    .needs = {.transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
