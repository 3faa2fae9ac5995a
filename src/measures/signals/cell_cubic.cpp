#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/signals/trilinear_value.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

/// What one ray shows.
struct RayFindings {
  std::int64_t cells = 0;
  double value_error = 0;
  double cubic_term = 0;
  double value_jump = 0;  ///< the largest
  std::vector<double> slope_jumps;
};

/// The value straight from eight voxels, in 50 digits, at start + u length of the piece.
double value_error(const Grid& grid, const Ray& ray, const Piece<3>& piece, double u) {
  const auto direction = unit_direction(ray.direction);
  const Real50 t = Real50(piece.start.high) + Real50(piece.start.low) + Real50(u) * Real50(piece.length);
  std::array<Real50, 3> point;
  for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = Real50(ray.origin[axis]) + t * Real50(direction[axis]);
  return std::abs(to_double(Real50(piece.polynomial.value(u)) - trilinear_value(grid, point)));
}

RayFindings examine(const Grid& grid, const Ray& ray, std::uint64_t seed, std::uint64_t index) {
  const Chain<3> signal = trace_trilinear(grid, ray);
  RayFindings findings;
  findings.cells = static_cast<std::int64_t>(signal.pieces.size());
  for (std::size_t i = 0; i < signal.pieces.size(); ++i) {
    const auto& piece = signal.pieces[i];
    const auto& b = piece.polynomial.coefficients;
    const double u = random_numbers(seed, RandomStream::points, index, static_cast<std::uint32_t>(i))[0];
    findings.value_error = std::max(findings.value_error, value_error(grid, ray, piece, u));
    findings.cubic_term = std::max(findings.cubic_term, std::abs((b[3] - b[0]) - 3 * (b[2] - b[1])));
    if (i == 0) continue;
    const auto& before = signal.pieces[i - 1];
    findings.value_jump = std::max(findings.value_jump, std::abs(b[0] - before.polynomial.coefficients[3]));
    findings.slope_jumps.push_back(std::abs(piece.polynomial.derivative().coefficients.front() / piece.length -
                                            before.polynomial.derivative().coefficients.back() / before.length));
  }
  return findings;
}

struct Record {
  std::int64_t rays = 0;
  std::int64_t cells = 0;
  double value_error = 0;
  double cubic_term = 0;
  double value_jump = 0;
  ShownQuantiles slope_jumps = {};
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "rays", .description = "rays drawn", .cell = &Record::rays},
      {.name = "cells", .description = "pieces of all rays, one for each cell crossed", .cell = &Record::cells},
      {.name = "value_error_max",
       .unit = "scalar",
       .description = "largest deviation of the cubic from the eight voxels' value in 50 digits, at a random point of "
                      "every cell; the field has range 1",
       .cell = &Record::value_error},
      {.name = "cubic_term_max",
       .unit = "scalar",
       .description = "largest coefficient of u^3, u = 0 ... 1 in the cell",
       .cell = &Record::cubic_term},
      {.name = "value_jump_max",
       .unit = "scalar",
       .description = "largest jump of the value between two cells",
       .cell = &Record::value_jump},
  };
  append_part(columns, &Record::slope_jumps,
              shown_quantile_columns("slope_jump", "scalar/voxel", "jump of the slope between two cells"));
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  std::vector<RayFindings> rays(static_cast<std::size_t>(experiment.rays.count));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray)
      rays[ray] = examine(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray),
                          experiment.seed, ray);
  });

  Record record{.rays = experiment.rays.count};
  std::vector<double> slope_jumps;
  for (const RayFindings& ray : rays) {
    record.cells += ray.cells;
    record.value_error = std::max(record.value_error, ray.value_error);
    record.cubic_term = std::max(record.cubic_term, ray.cubic_term);
    record.value_jump = std::max(record.value_jump, ray.value_jump);
    slope_jumps.insert(slope_jumps.end(), ray.slope_jumps.begin(), ray.slope_jumps.end());
  }
  std::sort(slope_jumps.begin(), slope_jumps.end());
  record.slope_jumps = shown_quantiles(slope_jumps);
  return {record};
}

}  // namespace

extern const Measure cell_cubic_measure;
const Measure cell_cubic_measure{MeasureDefinition<Options, Record>{
    .name = "cell_cubic",
    .summary = "whether a trilinear ray is a cubic inside each cell, and how its slope jumps between cells",
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
