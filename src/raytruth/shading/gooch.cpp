#include "raytruth/shading/gooch.hpp"
#include "raytruth/transfer/emission.hpp"

namespace raytruth {

Vector3<double> gooch_color(const SlabOptics& optics, Emission emission, const NormalCurve& curve, double light_front,
                            double light_back, double cosine, const Gooch& gooch, bool is_printed) {
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
