#pragma once

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
FittedOrder fit_order(const std::vector<StepError>& points);

}  // namespace raytruth
