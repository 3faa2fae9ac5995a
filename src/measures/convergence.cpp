#include "measures/convergence.hpp"

#include <fmt/format.h>

#include <cmath>

namespace raytruth {

namespace {

constexpr int coarsest = 3;

// Errors closer than this to their radius take no part in a fit.
constexpr double meaningful_radii = 10;

int exponent_of(std::size_t level) { return coarsest + static_cast<int>(level); }

}  // namespace

double step_of(std::size_t level) { return std::ldexp(1.0, -exponent_of(level)); }

void sample(const Chain<3>& signal, Regime regime, std::size_t level, Samples<double>& samples) {
  if (regime == Regime::cells)
    sample_cells(signal, samples, 1 << exponent_of(level));
  else
    sample_constant(signal, step_of(level), samples);
}

Columns<ConvergenceKeys> convergence_key_columns() {
  return {
      {.name = "regime",
       .description = "cells: every cell divided alike, no interval crosses a border; constant: a constant step",
       .is_key = true,
       .cell = &ConvergenceKeys::regime},
      {.name = "scheme", .description = "the scheme", .is_key = true, .cell = &ConvergenceKeys::scheme},
      {.name = "part",
       .description = "point: errors at one step; fit: the orders",
       .is_key = true,
       .cell = [](const ConvergenceKeys& keys) { return keys.step ? "point" : "fit"; }},
      {.name = "step",
       .unit = "cell or voxel",
       .description = "distance of samples",
       .is_key = true,
       .cell = [](const ConvergenceKeys& keys) { return cell_if(keys.step.has_value(), keys.step); }},
  };
}

Columns<ShownOrder> shown_order_columns(const std::string& name, const std::string& errors) {
  return {
      {.name = "order_" + name,
       .description = fmt::format("slope of log {} over log step, least squares over steps 2^-{} to 2^-{}, without "
                                  "points within {} radii",
                                  errors, exponent_of(0), exponent_of(level_count - 1), meaningful_radii),
       .cell = [](const ShownOrder& order) { return order.fit ? std::optional(order.fit->order) : std::nullopt; }},
      {.name = "order_" + name + "_residual",
       .description = "root mean square of log2 of the errors about the line",
       .cell = [](const ShownOrder& order) { return order.fit ? std::optional(order.fit->residual) : std::nullopt; }},
      {.name = "order_" + name + "_finest",
       .unit = "cell or voxel",
       .description = "least step in the fit",
       .cell = &ShownOrder::finest},
  };
}

ShownOrder shown_order(std::span<const LevelError> levels) {
  std::vector<StepError> points;
  for (std::size_t level = 0; level < levels.size(); ++level)
    if (levels[level].error > meaningful_radii * levels[level].radius)
      points.push_back({step_of(level), levels[level].error});
  if (points.size() < 2) return {};
  return {fit_order(points), points.back().step};
}

}  // namespace raytruth
