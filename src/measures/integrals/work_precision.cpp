#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/statistics/pareto.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

// An error closer than this to the reference's radius is none that could be compared.
constexpr double meaningful_radii = 10;

/// The scheme that look-ups and composites are compared with.
constexpr std::string_view first_order = "order1";

/// A scheme at one sampling, over rays.
struct Work {
  RayErrors total;
  RayErrors signal;
  RayErrors quadrature;
  RayErrors round32;
  double fetches = 0;  ///< sums over rays
  double voxels = 0;
  double lookups = 0;
  double composites = 0;
  std::string_view refusal;

  void add(const ErrorBudget& budget) {
    refusal = budget.outcome.refusal;
    if (!refusal.empty()) return;
    total.add(budget.total, budget.radius);
    signal.add(budget.signal, budget.radius);
    quadrature.add(budget.quadrature, budget.radius);
    if (budget.round32) round32.add(*budget.round32, 0);
    fetches += static_cast<double>(budget.outcome.fetches);
    voxels += static_cast<double>(budget.outcome.voxels);
    lookups += static_cast<double>(budget.outcome.lookups);
    composites += static_cast<double>(budget.outcome.composites);
  }
};

/// By scheme.
std::vector<Work> measure_work(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer,
                               const Sampling& sampling) {
  const auto schemes = schemes_of(experiment);
  std::vector<std::vector<ErrorBudget>> rays(static_cast<std::size_t>(experiment.rays.count));
  study_rays(experiment, field, transfer, [&](const StudiedRay& ray) {
    Samples<double> samples;
    sample(ray.signal, sampling, samples);
    for (const IntegralScheme* scheme : schemes)
      rays[ray.index].push_back(ray.integrate.budget(*scheme, ray.signal, samples, ray.truth));
  });
  std::vector<Work> works(schemes.size());
  for (const auto& ray : rays)
    for (std::size_t scheme = 0; scheme < ray.size(); ++scheme) works[scheme].add(ray[scheme]);
  return works;
}

std::optional<double> mean(double sum, const Work& work) {
  return work.total.rays.empty() ? std::nullopt : std::optional(sum / static_cast<double>(work.total.rays.size()));
}

std::optional<double> ratio(double sum, double first_sum) {
  return first_sum > 0 ? std::optional(sum / first_sum) : std::nullopt;
}

/// A part of the error, root mean square over rays; none where no ray has such a part.
struct PartErrors {
  std::optional<double> opacity_rms;
  std::optional<double> color_rms;
};

PartErrors part_of(const RayErrors& errors) {
  if (errors.rays.empty()) return {};
  return {rms_opacity(errors), rms_color(errors)};
}

/// What a scheme at one sampling does, and how close it comes.
struct WorkErrors {
  RayCounts rays;
  std::optional<double> fetches;  ///< means over rays
  std::optional<double> voxels;
  std::optional<double> lookups;
  std::optional<double> composites;
  std::optional<double> lookups_ratio;  ///< over those of the first order
  std::optional<double> composites_ratio;
  ErrorSummary errors;
  PartErrors signal;
  PartErrors quadrature;
  PartErrors round32;
};

WorkErrors work_errors(const Experiment& experiment, const Work& work, const Work& first) {
  return {.rays = ray_counts(experiment, work.total.rays.size()),
          .fetches = mean(work.fetches, work),
          .voxels = mean(work.voxels, work),
          .lookups = mean(work.lookups, work),
          .composites = mean(work.composites, work),
          .lookups_ratio = ratio(work.lookups, first.lookups),
          .composites_ratio = ratio(work.composites, first.composites),
          .errors = summary_of(work.total),
          .signal = part_of(work.signal),
          .quadrature = part_of(work.quadrature),
          .round32 = part_of(work.round32)};
}

struct Record {
  TransferKeys transfer;
  Sampling sampling;
  std::string scheme;
  std::optional<WorkErrors> work = {};
  std::optional<bool> is_on_opacity_front = {};  ///< none: of what cannot be compared
  std::optional<bool> is_on_color_front = {};
  std::optional<std::string> refusal = {};
};

/// Marks the records from `begin` on that no other of them beats in voxels read and error alike.
void mark_front(std::vector<Record>& records, std::size_t begin, std::optional<QuantityErrors> ErrorSummary::*errors,
                std::optional<bool> Record::*is_on_front) {
  std::vector<std::size_t> marked;
  std::vector<CostError> points;
  for (std::size_t i = begin; i < records.size(); ++i) {
    if (!records[i].work) continue;
    const WorkErrors& work = *records[i].work;
    const auto& error = work.errors.*errors;
    if (!work.voxels || !error) continue;
    marked.push_back(i);
    points.push_back({*work.voxels, error->rms > meaningful_radii * work.errors.radius ? error->rms : 0});
  }
  const auto front = pareto_front(points);
  for (std::size_t i = 0; i < marked.size(); ++i) records[marked[i]].*is_on_front = front[i];
}

Columns<PartErrors> part_columns(const std::string& name, const std::string& description) {
  const auto column = [&](const std::string& quantity, std::optional<double> PartErrors::*rms) {
    return RecordColumn<PartErrors>{.name = name + "_" + quantity + "_rms",
                                    .description = "part of the error, root mean square over rays: " + description,
                                    .radius = "radius",
                                    .cell = rms};
  };
  return {column("opacity", &PartErrors::opacity_rms), column("color", &PartErrors::color_rms)};
}

Columns<WorkErrors> work_columns() {
  Columns<WorkErrors> columns;
  append_part(columns, &WorkErrors::rays, ray_count_columns());
  append(columns, {{.name = "fetches_mean",
                    .description = "samples of the signal on a ray, mean over rays",
                    .cell = &WorkErrors::fetches},
                   {.name = "voxels_mean",
                    .description = "voxels read for a ray: eight for a sample, eight for an exact cell; mean over rays",
                    .cell = &WorkErrors::voxels},
                   {.name = "lookups_mean",
                    .description = "look-ups in a table on a ray, mean over rays",
                    .cell = &WorkErrors::lookups},
                   {.name = "composites_mean",
                    .description = "slabs composited on a ray, mean over rays",
                    .cell = &WorkErrors::composites},
                   {.name = "lookups_ratio",
                    .description = "look-ups over those of order1 at the same samples",
                    .cell = &WorkErrors::lookups_ratio},
                   {.name = "composites_ratio",
                    .description = "composites over those of order1 at the same samples",
                    .cell = &WorkErrors::composites_ratio}});
  append_part(columns, &WorkErrors::errors, error_summary_columns("", "a ray minus the certified reference"));
  append_part(columns, &WorkErrors::signal,
              part_columns("signal", "the approximate signal, integrated exactly, minus the truth"));
  append_part(columns, &WorkErrors::quadrature,
              part_columns("quadrature", "the scheme in binary64 minus the exact integral of its signal"));
  append_part(columns, &WorkErrors::round32,
              part_columns("round32", "the scheme in binary32 minus the scheme in binary64, sampled schemes only"));
  return columns;
}

RecordColumn<Record> front_column(const std::string& quantity, std::optional<bool> Record::*is_on_front) {
  return {.name = quantity + "_front",
          .description =
              "whether no other row of the field and transfer function reads as few voxels with "
              "as small a " +
              quantity + "_rms, and one of them less; within 10 radii it is none",
          .cell = [is_on_front](const Record& record) {
            return cell_if((record.*is_on_front).has_value(), record.*is_on_front);
          }};
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::transfer, transfer_key_columns());
  append_part(columns, &Record::sampling, sampling_key_columns());
  columns.push_back({.name = "scheme", .description = "the scheme", .is_key = true, .cell = &Record::scheme});
  append_part(columns, &Record::work, work_columns());
  append_refusal(columns, &Record::refusal);
  columns.push_back(front_column("opacity", &Record::is_on_opacity_front));
  columns.push_back(front_column("color", &Record::is_on_color_front));
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  const auto first_scheme = std::find(experiment.schemes.begin(), experiment.schemes.end(), first_order);
  const auto first = static_cast<std::size_t>(first_scheme - experiment.schemes.begin());
  std::vector<Record> records;
  for (const NamedTransfer& transfer : experiment.transfers) {
    const std::size_t begin = records.size();
    for (const Sampling& sampling : experiment.samplings) {
      const auto works = measure_work(experiment, field, transfer.transfer, sampling);
      for (std::size_t scheme = 0; scheme < works.size(); ++scheme) {
        const Work& work = works[scheme];
        Record& record = records.emplace_back(Record{.transfer = {transfer.name, experiment.emission},
                                                     .sampling = sampling,
                                                     .scheme = experiment.schemes[scheme]});
        if (work.refusal.empty())
          record.work = work_errors(experiment, work, first < works.size() ? works[first] : Work{});
        else
          record.refusal = std::string(work.refusal);
      }
    }
    mark_front(records, begin, &ErrorSummary::opacity, &Record::is_on_opacity_front);
    mark_front(records, begin, &ErrorSummary::color, &Record::is_on_color_front);
  }
  return records;
}

}  // namespace

extern const Measure work_precision_measure;
const Measure work_precision_measure{MeasureDefinition<Options, Record>{
    .name = "work_precision",
    .summary = "errors of colour and opacity by their causes, against what a scheme reads and does",
    .needs = {.schemes = true, .transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
