#pragma once

#include "raytruth/core/error.hpp"

#include <cmath>
#include <vector>

namespace raytruth {

/// An error at a step.
struct StepError {
  double step = 0;
  double error = 0;
};

/// error ~ constant step^order.
struct FittedOrder {
  double order = 0;
  double residual = 0;  ///< root mean square of log2(error) about the line
};

/// The slope of log2(error) over log2(step) by least squares. Throws InputError for fewer than two different steps, or
/// for a step or an error that is not positive.
inline FittedOrder fit_order(const std::vector<StepError>& points) {
  const auto count = static_cast<double>(points.size());
  double mean_x = 0;
  double mean_y = 0;
  for (const auto& [step, error] : points) {
    if (!(step > 0 && error > 0)) throw InputError("an order is fitted to positive steps and errors only");
    mean_x += std::log2(step) / count;
    mean_y += std::log2(error) / count;
  }
  double xx = 0;
  double xy = 0;
  for (const auto& [step, error] : points) {
    const double x = std::log2(step) - mean_x;
    xx += x * x;
    xy += x * (std::log2(error) - mean_y);
  }
  if (!(xx > 0)) throw InputError("an order is fitted to two different steps at least");
  FittedOrder fit{.order = xy / xx, .residual = 0};
  for (const auto& [step, error] : points) {
    const double off = std::log2(error) - mean_y - fit.order * (std::log2(step) - mean_x);
    fit.residual += off * off / count;
  }
  fit.residual = std::sqrt(fit.residual);
  return fit;
}

}  // namespace raytruth
