#include "raytruth/metrics/sample_error.hpp"

namespace raytruth {

SampleError& SampleError::operator+=(const SampleError& other) {
  count += other.count;
  sum_of_squares += other.sum_of_squares;
  maximum = std::max(maximum, other.maximum);
  return *this;
}

std::optional<double> SampleError::rmse() const {
  if (count == 0) return {};
  return std::sqrt(sum_of_squares / static_cast<double>(count));
}

std::optional<double> SampleError::psnr(double peak) const {
  const auto error = rmse();
  if (!error || *error == 0) return {};
  return 20 * std::log10(peak / *error);
}

}  // namespace raytruth
