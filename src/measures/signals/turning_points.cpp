#include "experiments/measure.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/statistics/proportion.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

/// How many of the cells that rays cross have 0, 1 and 2 turning points: sign changes of s' strictly inside.
struct Cells {
  std::array<std::int64_t, 3> by_turning_points{};
  std::int64_t constant = 0;

  [[nodiscard]] std::int64_t count() const {
    return by_turning_points[0] + by_turning_points[1] + by_turning_points[2];
  }
};

/// The longest way through a cell, in voxels.
constexpr double cell_diagonal = std::numbers::sqrt3;

/// Counts the cells that the ray enters at least a diagonal before its end. It crosses all of these to their other
/// border, however long the way is: to leave out those that it crosses in part would favour short ways.
Cells cells_of(const Chain<3>& signal) {
  Cells cells;
  const double last_entry = signal.length() - cell_diagonal;
  for (std::size_t i = 1; i + 1 < signal.pieces.size(); ++i) {
    if (signal.pieces[i].start.high > last_entry) break;
    const auto& polynomial = signal.pieces[i].polynomial;
    ++cells.by_turning_points[polynomial.derivative().sign_changes().size()];
    const auto& b = polynomial.coefficients;
    cells.constant += b[0] == b[1] && b[0] == b[2] && b[0] == b[3] ? 1 : 0;
  }
  return cells;
}

struct Record {
  std::int64_t rays = 0;
  Cells cells;
  Proportion probability;  ///< of two turning points in a cell
};

std::optional<double> share_of_not_constant(const Record& record) {
  const std::int64_t not_constant = record.cells.count() - record.cells.constant;
  if (not_constant == 0) return std::nullopt;
  return static_cast<double>(record.cells.by_turning_points[2]) / static_cast<double>(not_constant);
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "rays", .description = "rays drawn", .cell = &Record::rays},
      {.name = "cells",
       .description =
           "cells crossed from border to border, of those that a ray enters at least sqrt 3 voxels before its end",
       .cell = [](const Record& record) { return record.cells.count(); }},
      {.name = "cells_constant",
       .description = "of these, cells with a constant signal",
       .cell = [](const Record& record) { return record.cells.constant; }},
      {.name = "one_turning_point",
       .description = "cells in which the slope changes sign once",
       .cell = [](const Record& record) { return record.cells.by_turning_points[1]; }},
      {.name = "two_turning_points",
       .description = "cells in which the slope changes sign twice",
       .cell = [](const Record& record) { return record.cells.by_turning_points[2]; }},
      {.name = "probability",
       .description = "of two turning points in a cell: their share",
       .cell = [](const Record& record) { return record.probability.estimate; }},
      {.name = "probability_low",
       .description = "95 % interval, clustered by ray",
       .cell = [](const Record& record) { return record.probability.low; }},
      {.name = "probability_high",
       .description = "95 % interval, clustered by ray",
       .cell = [](const Record& record) { return record.probability.high; }},
      {.name = "probability_not_constant",
       .description = "the share among cells that are not constant",
       .cell = share_of_not_constant},
  };
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  std::vector<Cells> rays(static_cast<std::size_t>(experiment.rays.count));
  tbb::enumerable_thread_specific<Chain<3>> signals;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
    Chain<3>& signal = signals.local();
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray) {
      trace_trilinear(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray), signal);
      rays[ray] = cells_of(signal);
    }
  });

  std::vector<Cluster> clusters;
  Record record{.rays = experiment.rays.count, .cells = {}, .probability = {}};
  for (const Cells& ray : rays) {
    clusters.push_back({.hits = ray.by_turning_points[2], .trials = ray.count()});
    for (std::size_t i = 0; i < 3; ++i) record.cells.by_turning_points[i] += ray.by_turning_points[i];
    record.cells.constant += ray.constant;
  }
  record.probability = clustered_proportion(clusters);
  return {record};
}

}  // namespace

extern const Measure turning_points_measure;
const Measure turning_points_measure{
    MeasureDefinition<Options, Record>{.name = "turning_points",
                                       .summary = "how often the cubic inside a cell turns twice",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_field = records_of_field}};

}  // namespace raytruth
