#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace raytruth {

/// J_k(y) = integral from 0 to 1 of v^k exp(-y v) dv, k = 0 to 3, for y >= 0: how light that is sent out evenly along a
/// homogeneous stretch of optical depth y is distributed. By parts y J_k = k J_(k-1) - e^-y: upwards this loses digits
/// for small y, downwards it adds positive numbers. So up to y = 4 it begins with the series
///
///     J_3 = e^-y sum over n of y^n / (4 5 ... (4 + n))   (Abramowitz and Stegun, 6.5.29)
///
/// and goes downwards; from y = 4 on it goes upwards. The relative error is a few units in the last place.
inline std::array<double, 4> exponential_moments(double y) {
  std::array<double, 4> moments{};
  const double transmittance = std::exp(-y);
  if (y < 4) {
    double term = 0.25;
    for (int n = 1; moments[3] + term > moments[3]; ++n) {
      moments[3] += term;
      term *= y / (4 + n);
    }
    moments[3] *= transmittance;
    for (std::size_t k = 3; k > 0; --k) moments[k - 1] = (y * moments[k] + transmittance) / static_cast<double>(k);
  } else {
    moments[0] = -std::expm1(-y) / y;
    for (std::size_t k = 1; k < moments.size(); ++k)
      moments[k] = (static_cast<double>(k) * moments[k - 1] - transmittance) / y;
  }
  return moments;
}

}  // namespace raytruth
