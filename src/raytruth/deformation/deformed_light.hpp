#pragma once

#include "raytruth/deformation/deformed_ray.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

/// The certified light of deformed rays: extinction tau(s) / J and emission tau(s) c / J, of plain emission c / J, per
/// length of the world, so that a piece of the object keeps what it absorbs and shines in all, however it is stretched.
///
/// It is the integral along sigma, d sigma = dt / J. A relative error e of all d sigma changes the transmittance by at
/// most e mu exp(-(1 - e) mu), mu the depth before it, and so the opacity by less than e / 2, colours by less than
/// 2 e / (1 - e)^2 times the brightest one, and those of plain emission by 3 e / 2 times that and the length.
class DeformedLight {
 public:
  DeformedLight(const PiecewiseLinear& transfer, Emission emission);

  Certified operator()(const DeformedSignal& signal, double tolerance = 1e-9);

 private:
  RayIntegral integrate_;
  Emission emission_;
  double brightest_ = 0;
};

}  // namespace raytruth
