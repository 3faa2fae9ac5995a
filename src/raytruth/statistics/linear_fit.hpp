#pragma once

#include <vector>

namespace raytruth {

/// What is known of a case, and what is to be predicted.
struct Observation {
  std::vector<double> features;
  double value = 0;
};

/// value ~ c_0 + c_1 x_1 + ... + c_k x_k.
struct LinearFit {
  std::vector<double> coefficients;  ///< c_0 first

  [[nodiscard]] double operator()(const std::vector<double>& features) const;
};

/// Fits by least squares. Features that the observations do not tell apart share their weight (least norm). Throws
/// InputError without observations, or for observations with different numbers of features.
LinearFit fit_linear(const std::vector<Observation>& observations);

}  // namespace raytruth
