#include "raytruth/statistics/linear_fit.hpp"

#include "raytruth/core/error.hpp"

#include <Eigen/Dense>

namespace raytruth {

double LinearFit::operator()(const std::vector<double>& features) const {
  double value = coefficients.front();
  for (std::size_t i = 0; i < features.size(); ++i) value += coefficients[i + 1] * features[i];
  return value;
}

LinearFit fit_linear(const std::vector<Observation>& observations) {
  if (observations.empty()) throw InputError("a line is fitted to one observation at least");
  const std::size_t count = observations.front().features.size();
  Eigen::MatrixXd features(observations.size(), count + 1);
  Eigen::VectorXd values(observations.size());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const auto& [its_features, value] = observations[i];
    if (its_features.size() != count) throw InputError("a line is fitted to observations of equally many features");
    const auto row = static_cast<Eigen::Index>(i);
    features(row, 0) = 1;
    for (std::size_t k = 0; k < count; ++k) features(row, static_cast<Eigen::Index>(k + 1)) = its_features[k];
    values[row] = value;
  }
  const Eigen::VectorXd solution = features.completeOrthogonalDecomposition().solve(values);
  return {{solution.begin(), solution.end()}};
}

}  // namespace raytruth
