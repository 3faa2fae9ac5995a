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
#include <limits>

namespace raytruth {

namespace {

/// What one ray shows.
struct RayFindings {
  std::int64_t cells = 0;
  double value_error = 0;
  double cubic_term = 0;
  std::vector<double> value_jumps;
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
    findings.value_jumps.push_back(std::abs(b[0] - before.polynomial.coefficients[3]));
    findings.slope_jumps.push_back(std::abs(piece.polynomial.derivative().coefficients.front() / piece.length -
                                            before.polynomial.derivative().coefficients.back() / before.length));
  }
  return findings;
}

}  // namespace

std::vector<Column> cell_cubic_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  options.only({"kind"});
  std::vector<Column> columns{
      {.name = "rays", .unit = "", .description = "rays drawn"},
      {.name = "cells", .unit = "", .description = "pieces of all rays, one for each cell crossed"},
      {.name = "value_error_max",
       .unit = "scalar",
       .description = "largest deviation of the cubic from the eight voxels' value in 50 digits, at a random point of "
                      "every cell; the field has range 1"},
      {.name = "cubic_term_max",
       .unit = "scalar",
       .description = "largest coefficient of u^3, u = 0 ... 1 in the cell"},
      {.name = "value_jump_max", .unit = "scalar", .description = "largest jump of the value between two cells"},
  };
  const auto jumps = quantile_columns("slope_jump", "scalar/voxel", "jump of the slope between two cells");
  columns.insert(columns.end(), jumps.begin(), jumps.end());
  return columns;
}

std::vector<Row> cell_cubic_rows(const Experiment& experiment, const JsonReader& /*options*/, const Field& field) {
  std::vector<RayFindings> rays(static_cast<std::size_t>(experiment.rays.count));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray)
      rays[ray] = examine(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray),
                          experiment.seed, ray);
  });

  RayFindings all;
  for (const RayFindings& ray : rays) {
    all.cells += ray.cells;
    all.value_error = std::max(all.value_error, ray.value_error);
    all.cubic_term = std::max(all.cubic_term, ray.cubic_term);
    all.value_jumps.insert(all.value_jumps.end(), ray.value_jumps.begin(), ray.value_jumps.end());
    all.slope_jumps.insert(all.slope_jumps.end(), ray.slope_jumps.begin(), ray.slope_jumps.end());
  }
  std::sort(all.slope_jumps.begin(), all.slope_jumps.end());

  Row row{{"rays", experiment.rays.count},
          {"cells", all.cells},
          {"value_error_max", all.value_error},
          {"cubic_term_max", all.cubic_term},
          {"value_jump_max",
           all.value_jumps.empty() ? 0.0 : *std::max_element(all.value_jumps.begin(), all.value_jumps.end())}};
  add_quantiles(row, "slope_jump", all.slope_jumps);
  return {row};
}

}  // namespace raytruth
