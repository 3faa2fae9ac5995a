#include "raytruth/statistics/pareto.hpp"

#include <algorithm>

namespace raytruth {

std::vector<bool> pareto_front(const std::vector<CostError>& points) {
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
