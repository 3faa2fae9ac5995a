#pragma once

#include <Eigen/Core>

namespace raytruth {

/// Three linear-light channels; arithmetic is per channel, as GLSL's vec3.
template <class Real>
using Vector3 = Eigen::Array<Real, 3, 1>;

/// What a stretch of a ray does: the light it sends to its front, and the share of light that passes through it.
/// The default is the empty slab, the unit of `over`.
template <class Real>
struct Slab {
  Vector3<Real> radiance = Vector3<Real>::Constant(Real(0));
  Real transmittance = Real(1);

  /// A = 1 - T.
  [[nodiscard]] Real opacity() const { return Real(1) - transmittance; }
};

/// `front` seen before `back`: C = C_f + T_f C_b, T = T_f T_b (Porter and Duff 1984, with associated colours).
/// Associative; the empty slab is its unit.
template <class Real>
Slab<Real> over(const Slab<Real>& front, const Slab<Real>& back) {
  return {front.radiance + front.transmittance * back.radiance, front.transmittance * back.transmittance};
}

}  // namespace raytruth
