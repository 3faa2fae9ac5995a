#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace raytruth {

/// The differences between two sets of samples taken at the same places, one by one or set by set.
struct SampleError {
  std::int64_t count = 0;
  double sum_of_squares = 0;
  double maximum = 0;  ///< largest magnitude

  void add(double difference) {
    ++count;
    sum_of_squares += difference * difference;
    maximum = std::max(maximum, std::abs(difference));
  }

  SampleError& operator+=(const SampleError& other) {
    count += other.count;
    sum_of_squares += other.sum_of_squares;
    maximum = std::max(maximum, other.maximum);
    return *this;
  }

  /// sqrt(mean of squared differences); none without samples.
  [[nodiscard]] std::optional<double> rmse() const {
    if (count == 0) return {};
    return std::sqrt(sum_of_squares / static_cast<double>(count));
  }

  /// 20 log10(peak / RMSE), in dB; none where the RMSE is none or 0.
  [[nodiscard]] std::optional<double> psnr(double peak) const {
    const auto error = rmse();
    if (!error || *error == 0) return {};
    return 20 * std::log10(peak / *error);
  }
};

}  // namespace raytruth
