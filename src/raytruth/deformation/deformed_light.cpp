#include "raytruth/deformation/deformed_light.hpp"

#include <algorithm>

namespace raytruth {

DeformedLight::DeformedLight(const PiecewiseLinear& transfer, Emission emission)
    : integrate_(transfer, emission), emission_(emission) {
  for (const TransferPoint& point : transfer.points()) brightest_ = std::max(brightest_, point.optics.color.maxCoeff());
}

Certified DeformedLight::operator()(const DeformedSignal& signal, double tolerance) {
  Certified light = integrate_(signal.chain, signal.error, tolerance);
  const double e = signal.rate_error;
  // Beyond it the inequalities are not those below; so far off a ray tells nothing.
  constexpr double small = 0x1p-7;
  if (!(e <= small)) {
    light.radius = std::max(1.0, brightest_) * (emission_ == Emission::plain ? signal.chain.length() : 1);
    light.status = Status::not_converged;
    return light;
  }
  const double of_color =
      emission_ == Emission::associated ? 2.1 * e * brightest_ : 1.5 * e * brightest_ * signal.chain.length();
  light.radius += std::max(of_color, e / 2);
  const double size = std::max(1.0, brightest_ * (emission_ == Emission::plain ? signal.chain.length() : 1));
  if (light.radius > tolerance * size) light.status = Status::not_converged;
  return light;
}

}  // namespace raytruth
