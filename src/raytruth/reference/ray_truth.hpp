#pragma once

#include "raytruth/reference/ray_integral.hpp"

namespace raytruth {

/// The integral along a ray as well as it can be known: in binary64, and where that has not converged along the same
/// signal in 106 bits, which `make_precise()` gives as a PreciseChain; the one with the smaller radius.
template <int Degree, class MakePrecise>
Certified ray_truth(RayIntegral& integral, const Chain<Degree>& signal, const SignalError& error,
                    const MakePrecise& make_precise) {
  const Certified truth = integral(signal, error);
  if (truth.status == Status::converged) return truth;
  const Certified better = integral(make_precise());
  return better.radius < truth.radius ? better : truth;
}

}  // namespace raytruth
