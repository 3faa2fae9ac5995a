#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/statistics/pareto.hpp"

#include <algorithm>
#include <array>

namespace raytruth {

namespace {

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

Value mean(double sum, const Work& work) {
  return work.total.rays.empty() ? Value() : Value(sum / static_cast<double>(work.total.rays.size()));
}

Value ratio(double sum, double first_sum) { return first_sum > 0 ? Value(sum / first_sum) : Value(); }

struct Part {
  const char* name;
  const char* description;
  RayErrors Work::*errors;
};

constexpr std::array parts{
    Part{"signal", "the approximate signal, integrated exactly, minus the truth", &Work::signal},
    Part{"quadrature", "the scheme in binary64 minus the exact integral of its signal", &Work::quadrature},
    Part{"round32", "the scheme in binary32 minus the scheme in binary64, sampled schemes only", &Work::round32},
};

void add_work(Row& row, const Experiment& experiment, const Work& work, const Work& first) {
  add_counts(row, experiment, work.total.rays.size());
  row.insert(row.end(), {{"fetches_mean", mean(work.fetches, work)},
                         {"voxels_mean", mean(work.voxels, work)},
                         {"lookups_mean", mean(work.lookups, work)},
                         {"composites_mean", mean(work.composites, work)},
                         {"lookups_ratio", ratio(work.lookups, first.lookups)},
                         {"composites_ratio", ratio(work.composites, first.composites)}});
  add_errors(row, work.total);
  for (const auto& [name, description, errors] : parts) {
    const RayErrors& part = work.*errors;
    const std::string prefix = name;
    row.emplace_back(prefix + "_opacity_rms", part.rays.empty() ? Value() : Value(rms_opacity(part)));
    row.emplace_back(prefix + "_color_rms", part.rays.empty() ? Value() : Value(rms_color(part)));
  }
}

/// Marks the rows from `begin` on that no other of them beats in voxels read and error alike.
void mark_fronts(std::vector<Row>& rows, std::size_t begin) {
  for (const std::string name : {"opacity", "color"}) {
    std::vector<std::size_t> marked;
    std::vector<CostError> points;
    for (std::size_t i = begin; i < rows.size(); ++i) {
      const auto cost = as_number(cell(rows[i], "voxels_mean"));
      const auto error = as_number(cell(rows[i], name + "_rms"));
      if (!cost || !error) continue;
      marked.push_back(i);
      const double radius = as_number(cell(rows[i], "radius")).value_or(0);
      points.push_back({*cost, *error > meaningful_radii * radius ? *error : 0});
    }
    const auto is_on_front = pareto_front(points);
    for (std::size_t i = 0; i < marked.size(); ++i) rows[marked[i]].emplace_back(name + "_front", bool(is_on_front[i]));
  }
}

}  // namespace

std::vector<Column> work_precision_columns(const Experiment& experiment, const JsonReader& options) {
  options.only({"kind"});
  need_schemes(experiment);
  need_transfers(experiment);
  std::vector<Column> columns = transfer_columns();
  append(columns, sampling_columns());
  columns.push_back({.name = "scheme", .unit = "", .description = "the scheme", .is_key = true});
  append(columns, count_columns());
  append(
      columns,
      {{.name = "fetches_mean", .unit = "", .description = "samples of the signal on a ray, mean over rays"},
       {.name = "voxels_mean",
        .unit = "",
        .description = "voxels read for a ray: eight for a sample, eight for an exact cell; mean over rays"},
       {.name = "lookups_mean", .unit = "", .description = "look-ups in a table on a ray, mean over rays"},
       {.name = "composites_mean", .unit = "", .description = "slabs composited on a ray, mean over rays"},
       {.name = "lookups_ratio", .unit = "", .description = "look-ups over those of order1 at the same samples"},
       {.name = "composites_ratio", .unit = "", .description = "composites over those of order1 at the same samples"}});
  append(columns, error_columns("", "a ray minus the certified reference"));
  for (const auto& [name, description, errors] : parts)
    for (const std::string quantity : {"opacity", "color"})
      columns.push_back({.name = std::string(name) + "_" + quantity + "_rms",
                         .unit = "",
                         .description = "part of the error, root mean square over rays: " + std::string(description),
                         .is_key = false,
                         .radius = "radius"});
  for (const std::string quantity : {"opacity", "color"})
    columns.push_back(
        {.name = quantity + "_front",
         .unit = "",
         .description = "whether no other row of the field and transfer function reads as few voxels with "
                        "as small a " +
                        quantity + "_rms, and one of them less; within 10 radii it is none"});
  return columns;
}

std::vector<Row> work_precision_rows(const Experiment& experiment, const JsonReader& /*options*/, const Field& field) {
  const auto first_scheme = std::find(experiment.schemes.begin(), experiment.schemes.end(), first_order);
  const auto first = static_cast<std::size_t>(first_scheme - experiment.schemes.begin());
  std::vector<Row> rows;
  for (const NamedTransfer& transfer : experiment.transfers) {
    const std::size_t begin = rows.size();
    for (const Sampling& sampling : experiment.samplings) {
      const auto works = measure_work(experiment, field, transfer.transfer, sampling);
      for (std::size_t scheme = 0; scheme < works.size(); ++scheme) {
        const Work& work = works[scheme];
        Row& row = rows.emplace_back(transfer_keys(experiment, transfer));
        add_sampling(row, sampling);
        row.emplace_back("scheme", experiment.schemes[scheme]);
        if (work.refusal.empty())
          add_work(row, experiment, work, first < works.size() ? works[first] : Work{});
        else
          row.insert(row.end(), {{"status", "refused"}, {"why", std::string(work.refusal)}});
      }
    }
    mark_fronts(rows, begin);
  }
  return rows;
}

}  // namespace raytruth
