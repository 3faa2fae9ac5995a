#pragma once

#include <algorithm>
#include <vector>

namespace raytruth {

/// What something costs and how wrong it is.
struct CostError {
  double cost = 0;
  double error = 0;
};

/// Whether each of the points lies on the Pareto front: no other point is at least as good in both, and better in one.
/// Equal points are on it together.
inline std::vector<bool> pareto_front(const std::vector<CostError>& points) {
  std::vector<bool> is_on_front;
  is_on_front.reserve(points.size());
  for (const CostError& point : points)
    is_on_front.push_back(std::none_of(points.begin(), points.end(), [&point](const CostError& other) {
      return other.cost <= point.cost && other.error <= point.error &&
             (other.cost < point.cost || other.error < point.error);
    }));
  return is_on_front;
}

}  // namespace raytruth
