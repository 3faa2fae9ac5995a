#pragma once

#include <vector>

namespace raytruth {

/// What something costs and how wrong it is.
struct CostError {
  double cost = 0;
  double error = 0;
};

/// Whether each of the points lies on the Pareto front: no other point is at least as good in both, and better in one.
/// Equal points are on it together.
std::vector<bool> pareto_front(const std::vector<CostError>& points);

}  // namespace raytruth
