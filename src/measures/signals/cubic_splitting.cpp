#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/schemes/cubic_split.hpp"
#include "raytruth/schemes/order3.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/ray_field.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

struct Options {
  std::vector<FieldKind> signals;
  std::vector<double> steps;        ///< of four samples to a slab; may be none
  std::vector<double> mean_errors;  ///< of fewest, besides its own; may be none
  std::int64_t table_size = 0;
};

/// The names of the schemes that cut, and where.
constexpr std::array splits{std::pair{CubicSplitNone::info.name, CubicSplit::none},
                            std::pair{CubicSplitInflection::info.name, CubicSplit::inflection},
                            std::pair{CubicSplitExtrema::info.name, CubicSplit::extrema},
                            std::pair{CubicSplitMiddle::info.name, CubicSplit::middle},
                            std::pair{CubicSplitFewest::info.name, CubicSplit::fewest}};

/// The scheme of this name; the list's end if it cuts nothing.
auto split_named(std::string_view name) {
  return std::find_if(splits.begin(), splits.end(), [name](const auto& row) { return row.first == name; });
}

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "signals", "steps", "mean_errors", "table_size"});
  for (const std::string& scheme : experiment.schemes)
    if (split_named(scheme) == splits.end())
      json.refuse("the scheme " + scheme, "schemes whose names begin with cubic_split_");
  if (experiment.schemes.front() != CubicSplitNone::info.name)
    json.refuse("the first scheme " + experiment.schemes.front(),
                "cubic_split_none, which the others are compared with");
  Options options;
  const std::vector<std::string_view> names(field_kind_names.begin(), field_kind_names.end());
  for (const JsonReader& item : json.at("signals").items()) {
    const std::string name = item.word(names);
    options.signals.push_back(static_cast<FieldKind>(std::find(names.begin(), names.end(), name) - names.begin()));
  }
  if (const auto steps = json.find("steps"))
    for (const JsonReader& item : steps->items()) options.steps.push_back(item.positive_number());
  if (const auto mean_errors = json.find("mean_errors"))
    for (const JsonReader& item : mean_errors->items()) options.mean_errors.push_back(item.positive_number());
  options.table_size = json.at("table_size").integer(2, 256);
  return options;
}

/// A way to cut.
struct Cut {
  std::string scheme;
  CubicSplit split;
  std::optional<double> mean_error = {};  ///< of fewest; none: the scheme's own
};

/// All ways, the one that the others are compared with first. A slab's own range is asked of cubics alone.
std::vector<Cut> cuts_of(const Experiment& experiment, const Options& options, bool are_cubics) {
  std::vector<Cut> cuts;
  for (const std::string& scheme : experiment.schemes) {
    const CubicSplit split = split_named(scheme)->second;
    if (split != CubicSplit::fewest || are_cubics) cuts.push_back({scheme, split});
    if (split != CubicSplit::fewest) continue;
    for (const double mean_error : options.mean_errors) cuts.push_back({scheme, split, mean_error});
  }
  return cuts;
}

/// What a way to cut does to the slabs that count.
struct Findings {
  std::int64_t slabs = 0;
  std::int64_t cut = 0;  ///< of these, those in more than one part
  std::int64_t parts = 0;
  std::int64_t most_parts = 0;  ///< of one slab
  double length = 0;
  double xi = 0;
  double xi_uncut = 0;       ///< of one parabola, in slabs that are not cut
  double worst = 0;          ///< the largest mean of abs(s - s^) in a slab
  double formula_error = 0;  ///< the largest difference of xi from abs(a_3) sum of part^4 / 32, over the length

  void add(const Findings& other) {
    slabs += other.slabs;
    cut += other.cut;
    parts += other.parts;
    most_parts = std::max(most_parts, other.most_parts);
    length += other.length;
    xi += other.xi;
    xi_uncut += other.xi_uncut;
    worst = std::max(worst, other.worst);
    formula_error = std::max(formula_error, other.formula_error);
  }
};

/// A ray under one way to cut.
struct Trial {
  Findings findings = {};
  std::int64_t lookups = 0;
  Difference error = {};
  double radius = 0;
};

/// What every ray but the constant ones gives, by way to cut.
using Trials = std::vector<std::optional<std::vector<Trial>>>;

/// The longest way through a cell, in voxels.
constexpr double cell_diagonal = std::numbers::sqrt3;

/// A ray whose pieces are slabs to be cut; those from `first` on to before `last` count.
template <int Degree>
struct SlabRay {
  Chain<Degree> slabs;
  std::size_t first = 0;
  std::size_t last = 0;
};

/// The cells' own polynomials; those count that the ray crosses from border to border, of those that it enters at least
/// a diagonal before its end: to leave out those that it crosses in part would favour short ways.
template <int Degree>
void count_whole_cells(SlabRay<Degree>& ray) {
  const double last_entry = ray.slabs.length() - cell_diagonal;
  ray.first = 1;
  ray.last = 1;
  while (ray.last + 1 < ray.slabs.pieces.size() && ray.slabs.pieces[ray.last].start.high <= last_entry) ++ray.last;
}

/// The cubics through four samples each; all of them count.
void make_slabs_of_samples(const Chain<3>& signal, double step, Samples<double>& samples, SlabRay<3>& ray) {
  sample_constant(signal, step, samples);
  ray.slabs.pieces.clear();
  ray.slabs.end = signal.end;
  for (std::size_t k = 0; k < samples.interval_count(); k += Order3::slab_intervals(samples, k))
    ray.slabs.pieces.push_back(order3_slab(signal, samples, k));
  ray.first = 0;
  ray.last = full_intervals(samples) / 3;
}

/// abs(a_3) sum of part^4 / 32.
double area_by_formula(const Piece<3>& slab, const std::vector<double>& borders) {
  const auto& b = slab.polynomial.coefficients;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) sum += std::pow(borders[i + 1] - borders[i], 4);
  return std::abs((b[3] - b[0]) - 3 * (b[2] - b[1])) * sum * slab.length / 32;
}

template <int Degree>
Findings findings_of(const Piece<Degree>& slab, const std::vector<double>& borders) {
  Chain<3> parabolas;
  append_parts(slab, borders, parabolas);
  double mean = 0;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const auto own = slab.polynomial.restricted(borders[i], borders[i + 1]);
    const auto parabola = parabolas.pieces[i].polynomial.template elevated<Degree>();
    mean += (own - parabola).integral_of_magnitude() * (borders[i + 1] - borders[i]);
  }
  const auto parts = static_cast<std::int64_t>(borders.size()) - 1;
  Findings findings{.slabs = 1,
                    .cut = parts > 1 ? 1 : 0,
                    .parts = parts,
                    .most_parts = parts,
                    .length = slab.length,
                    .xi = mean * slab.length,
                    .xi_uncut = parts == 1 ? mean * slab.length : 0,
                    .worst = mean};
  if constexpr (Degree == 3) findings.formula_error = std::abs(mean - area_by_formula(slab, borders) / slab.length);
  return findings;
}

/// What a thread holds for its rays.
struct Worker {
  RayIntegral integrate;
  Samples<double> samples = {};
  Chain<3> signal = {};
  Chain<3> approximation = {};
  std::vector<double> borders = {};
};

template <int Degree>
std::vector<Trial> trials_of(const SlabRay<Degree>& ray, const std::vector<Cut>& cuts, Worker& worker) {
  const Certified truth = worker.integrate(ray.slabs);
  std::vector<Trial> trials;
  for (const Cut& cut : cuts) {
    Trial& trial = trials.emplace_back();
    worker.approximation.pieces.clear();
    worker.approximation.end = ray.slabs.end;
    for (std::size_t i = 0; i < ray.slabs.pieces.size(); ++i) {
      const auto& slab = ray.slabs.pieces[i];
      double mean_error = cut.mean_error.value_or(0);
      if constexpr (Degree == 3)
        if (!cut.mean_error) mean_error = fewest_tolerance(slab.polynomial);
      split_borders(slab.polynomial, cut.split, mean_error, worker.borders);
      append_parts(slab, worker.borders, worker.approximation);
      if (ray.first <= i && i < ray.last) trial.findings.add(findings_of(slab, worker.borders));
    }
    trial.lookups = static_cast<std::int64_t>(worker.approximation.pieces.size());
    const Certified cut_ray = worker.integrate(worker.approximation);
    trial.error = {cut_ray.color - truth.color, cut_ray.opacity - truth.opacity};
    trial.radius = cut_ray.radius + truth.radius;
  }
  return trials;
}

template <class FieldOfRays>
Trials measure_trials(const Experiment& experiment, const Field& field, const FieldOfRays& rays,
                      const PiecewiseLinear& transfer, std::optional<double> step, const std::vector<Cut>& cuts) {
  constexpr int degree = FieldOfRays::degree;
  Trials trials(static_cast<std::size_t>(experiment.rays.count));
  tbb::enumerable_thread_specific<Worker> workers(
      [&] { return Worker{.integrate = RayIntegral(transfer, experiment.emission)}; });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, trials.size()), [&](const auto& range) {
    Worker& worker = workers.local();
    SlabRay<degree> ray;
    for (std::size_t index = range.begin(); index < range.end(); ++index) {
      const Ray line = random_ray(field.grid, experiment.rays.length, experiment.seed, index);
      rays.trace(line, ray.slabs);
      if (ray.slabs.is_constant()) continue;
      count_whole_cells(ray);
      if constexpr (degree == 3) {
        if (step) {
          worker.signal = ray.slabs;
          make_slabs_of_samples(worker.signal, *step, worker.samples, ray);
        }
      }
      trials[index] = trials_of(ray, cuts, worker);
    }
  });
  return trials;
}

struct Keys {
  std::string signal;
  std::optional<double> step;
  std::string split;
  std::optional<double> mean_error;
};

/// What all rays come to under one way to cut.
struct Totals {
  Findings findings;
  std::int64_t lookups = 0;
  RayErrors errors;
};

Totals totals_of(const Trials& trials, std::size_t cut) {
  Totals totals;
  for (const auto& ray : trials) {
    if (!ray) continue;
    const Trial& trial = (*ray)[cut];
    totals.findings.add(trial.findings);
    totals.lookups += trial.lookups;
    totals.errors.add(trial.error, trial.radius);
  }
  return totals;
}

struct Record {
  TransferKeys transfer;
  Keys keys;
  RayCounts rays;
  std::int64_t studied = 0;
  Totals own = {};
  Totals none = {};  ///< of one parabola to a slab
  std::int64_t table_size = 0;
};

std::optional<double> ratio(double numerator, double denominator) {
  return denominator > 0 ? std::optional(numerator / denominator) : std::nullopt;
}

std::optional<double> share(std::int64_t part, std::int64_t whole) {
  return ratio(static_cast<double>(part), static_cast<double>(whole));
}

/// Look-ups as multiples of those of one parabola to a slab.
double lookups_ratio(const Record& record) { return share(record.own.lookups, record.none.lookups).value_or(1); }

double parts_ratio(const Record& record) {
  return share(record.own.findings.parts, record.own.findings.slabs).value_or(1);
}

std::optional<double> xi_gain(const Record& record) { return ratio(record.none.findings.xi, record.own.findings.xi); }
/// The gain in a root mean square of errors; none where one of the two is within its radius.
std::optional<double> gain_in(double (*rms)(const RayErrors&), const Record& record) {
  const double none = rms(record.none.errors);
  const double own = rms(record.own.errors);
  if (none <= record.none.errors.radius || own <= record.own.errors.radius) return std::nullopt;
  return none / own;
}

std::optional<double> opacity_gain(const Record& record) { return gain_in(rms_opacity, record); }
std::optional<double> color_gain(const Record& record) { return gain_in(rms_color, record); }

/// A gain over look-ups.
std::optional<double> over(std::optional<double> gain, double lookups) {
  return gain ? std::optional(*gain / lookups) : std::nullopt;
}

/// How many lengths of parts a table has to hold; none: any length.
std::optional<std::int64_t> part_lengths(const Record& record) {
  const bool any = record.keys.split == CubicSplitInflection::info.name ||
                   record.keys.split == CubicSplitExtrema::info.name || !record.keys.step;
  return any ? std::nullopt
             : std::optional(record.keys.split == CubicSplitFewest::info.name ? record.own.findings.most_parts : 1);
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::transfer, transfer_key_columns());
  append_part(
      columns, &Record::keys,
      Columns<Keys>{
          {.name = "signal",
           .description = "how voxels become the signal: trilinear, a cubic in every cell, or of degree 9",
           .is_key = true,
           .cell = &Keys::signal},
          {.name = "step",
           .unit = "voxel",
           .description = "slabs are cubics through four samples at this step; none: the cells' polynomials",
           .is_key = true,
           .cell = &Keys::step},
          {.name = "scheme", .description = "where a slab is cut", .is_key = true, .cell = &Keys::split},
          {.name = "mean_error",
           .unit = "scalar",
           .description = "of cubic_split_fewest: the largest mean of abs(s - s^) in a slab; none: 1/256 of the "
                          "range of its values at 0, 1/3, 2/3 and 1",
           .is_key = true,
           .cell = &Keys::mean_error}});
  append_part(columns, &Record::rays, ray_count_columns());
  append(
      columns,
      Columns<Record>{
          {.name = "slabs",
           .description = "slabs that count: all whole ones, of cells those crossed from border to border that a ray "
                          "enters at least sqrt 3 voxels before its end",
           .cell = [](const Record& record) { return record.own.findings.slabs; }},
          {.name = "split_share",
           .description = "share of these that are cut",
           .cell = [](const Record& record) { return share(record.own.findings.cut, record.own.findings.slabs); }},
          {.name = "lookups_per_slab", .description = "parts of a slab, on the mean: look-ups", .cell = parts_ratio},
          {.name = "most_parts",
           .description = "the most parts of a slab",
           .cell = [](const Record& record) { return record.own.findings.most_parts; }},
          {.name = "lookups",
           .description = "of a ray, on the mean, cells at its ends included",
           .cell = [](const Record& record) { return share(record.own.lookups, record.studied); }},
          {.name = "xi",
           .unit = "scalar",
           .description = "xi over the length, of all these slabs",
           .cell = [](const Record& record) { return ratio(record.own.findings.xi, record.own.findings.length); }},
          {.name = "xi_gain", .description = "summed xi of one parabola to a slab over summed xi", .cell = xi_gain},
          {.name = "xi_gain_per_lookup",
           .description = "the same over look-ups of a slab",
           .cell = [](const Record& record) { return over(xi_gain(record), parts_ratio(record)); }},
          {.name = "uncut_share",
           .description = "share of the summed xi of one parabola that lies in slabs that are not cut",
           .cell = [](const Record& record) { return ratio(record.own.findings.xi_uncut, record.none.findings.xi); }},
          {.name = "worst_mean_error",
           .unit = "scalar",
           .description = "largest mean of abs(s - s^) in a slab",
           .cell = [](const Record& record) { return record.own.findings.worst; }},
          {.name = "worst_gain",
           .description = "that of one parabola over it",
           .cell = [](const Record& record) { return ratio(record.none.findings.worst, record.own.findings.worst); }},
          {.name = "formula_error",
           .unit = "scalar",
           .description = "of cubics: largest difference of a slab's mean error, by the integral of abs(s - s^), from "
                          "abs(a_3) sum of part^4 / 32",
           .cell =
               [](const Record& record) {
                 return cell_if(record.keys.signal == field_kind_names[0], record.own.findings.formula_error);
               }},
          {.name = "opacity_rms",
           .description = "root mean square error of the opacity from the certified integral of the uncut slabs",
           .radius = "radius",
           .cell = [](const Record& record) { return rms_opacity(record.own.errors); }},
          {.name = "color_rms",
           .description = "the same of the colour, over channels too",
           .radius = "radius",
           .cell = [](const Record& record) { return rms_color(record.own.errors); }},
          {.name = "opacity_gain",
           .description =
               "opacity_rms of one parabola to a slab over opacity_rms; none where one of them is within its radius",
           .cell = opacity_gain},
          {.name = "color_gain", .description = "the same of color_rms", .cell = color_gain},
          {.name = "opacity_gain_per_lookup",
           .description = "opacity_gain over look-ups as multiples of those of one parabola to a slab",
           .cell = [](const Record& record) { return over(opacity_gain(record), lookups_ratio(record)); }},
          {.name = "color_gain_per_lookup",
           .description = "the same of color_gain",
           .cell = [](const Record& record) { return over(color_gain(record), lookups_ratio(record)); }},
          {.name = "part_lengths",
           .description = "how many lengths of parts a table has to hold; none: any, an axis of its own",
           .cell = part_lengths},
          {.name = "table_bytes",
           .unit = "byte",
           .description = "of RGBA in binary32 over front, middle and back scalar and the lengths, with table_size "
                          "entries on each axis",
           .cell =
               [](const Record& record) {
                 const std::int64_t n = record.table_size;
                 return 16 * n * n * n * part_lengths(record).value_or(n);
               }},
          {.name = "table_size", .description = "for table_bytes", .cell = &Record::table_size},
          {.name = "radius",
           .description = "bound on the error of opacity_rms and color_rms",
           .cell = [](const Record& record) { return record.own.errors.radius; }}});
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  std::vector<Record> records;
  for (const FieldKind kind : options.signals) {
    const RayField rays = ray_field(field.grid, kind, Border::half_voxel);
    const bool are_cubics = kind == FieldKind::trilinear;
    std::vector<std::optional<double>> steps{std::nullopt};
    if (are_cubics) steps.insert(steps.end(), options.steps.begin(), options.steps.end());
    const std::vector<Cut> cuts = cuts_of(experiment, options, are_cubics);
    for (const auto& step : steps)
      for (const NamedTransfer& transfer : experiment.transfers) {
        const Trials trials = std::visit(
            [&](const auto& own) { return measure_trials(experiment, field, own, transfer.transfer, step, cuts); },
            rays);
        const auto studied = static_cast<std::size_t>(
            std::count_if(trials.begin(), trials.end(), [](const auto& ray) { return ray.has_value(); }));
        const Totals none = totals_of(trials, 0);
        for (std::size_t cut = 0; cut < cuts.size(); ++cut)
          records.push_back({.transfer = {transfer.name, experiment.emission},
                             .keys = {.signal = std::string(field_kind_names[static_cast<std::size_t>(kind)]),
                                      .step = step,
                                      .split = cuts[cut].scheme,
                                      .mean_error = cuts[cut].mean_error},
                             .rays = ray_counts(experiment, studied),
                             .studied = static_cast<std::int64_t>(studied),
                             .own = totals_of(trials, cut),
                             .none = none,
                             .table_size = options.table_size});
      }
  }
  return records;
}

}  // namespace

extern const Measure cubic_splitting_measure;
const Measure cubic_splitting_measure{MeasureDefinition<Options, Record>{
    .name = "cubic_splitting",
    .summary = "what is gained where a slab's cubic is cut into parts, each replaced by a parabola",
    .needs = {.signal_schemes = true, .transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
