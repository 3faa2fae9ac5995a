#pragma once

#include "raytruth/shading/normal_curve.hpp"
#include "raytruth/shading/slab_optics.hpp"
#include "raytruth/transfer/emission.hpp"

namespace raytruth {

/// The tones of A. Gooch and others 1998 as Guetat 2010, eq. 11, has them.
struct Gooch {
  Vector3<double> cool{0, 0, 0.4};    ///< c_blue
  Vector3<double> warm{0.4, 0.4, 0};  ///< c_yellow
  double cool_share = 0.2;            ///< a: of the matter's colour in the cool tone
  double warm_share = 0.6;            ///< b
  double diffuse = 1;                 ///< K_d
};

/// Light that a slab sends to its front,
///
///     C = integral_0^D (1/2 (c_blue e + a K_d q)(1 + N.L) + 1/2 (c_yellow e + b K_d q)(1 - N.L)) T dt,
///
/// with e = tau (associated) or 1 (plain), so that empty space does not glow. In tables: a constant one, and one for
/// every power of s in N.L; as printed in Guetat 2010, section 5.3, the constant one is missing (errata, Guetat 10),
/// which `is_printed` leaves out. `light_front` and `light_back` are N_f.L and N_b.L, `cosine` is N_f.N_b.
inline Vector3<double> gooch_color(const SlabOptics& optics, Emission emission, const NormalCurve& curve,
                                   double light_front, double light_back, double cosine, const Gooch& gooch,
                                   bool is_printed = false) {
  const auto sums = slab_integral<2>(optics, emission, {}, [&](double x, double /*slope*/) {
    const double lit = light_front * curve.weight(1 - x, cosine) + light_back * curve.weight(x, cosine);
    return std::array<double, 2>{1, lit};
  });
  const auto [a, b] = std::pair{gooch.diffuse * gooch.cool_share, gooch.diffuse * gooch.warm_share};
  const Vector3<double> constant = sums.white[0] * (gooch.cool + gooch.warm) + (a + b) * sums.colored[0];
  const Vector3<double> linear = sums.white[1] * (gooch.cool - gooch.warm) + (a - b) * sums.colored[1];
  return 0.5 * (is_printed ? linear : Vector3<double>(constant + linear));
}

}  // namespace raytruth
