#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace raytruth {

/// A transfer function as a renderer looks it up, in any arithmetic: the scalar's emission density q (three channels)
/// and its extinction tau. Points are rounded to Real, everything in between is computed in it; opacities are
/// interpolated, then converted.
template <class Real>
class OpticsLookup {
 public:
  using vec4 = typename Rules<Real>::vec4;

  OpticsLookup(const PiecewiseLinear& transfer, Emission emission) : emission_(emission) {
    const auto& opacities = transfer.opacities();
    if (transfer.is_linear_in_opacity()) units_per_length_ = Real(1 / transfer.unit_length());
    for (std::size_t i = 0; i < transfer.points().size(); ++i) {
      const auto& [s, optics] = transfer.points()[i];
      const auto& [extinction, color] = optics;
      scalars_.emplace_back(s);
      points_.push_back(
          vec4(Real(color[0]), Real(color[1]), Real(color[2]), Real(opacities.empty() ? extinction : opacities[i])));
    }
  }

  /// q and tau at s; as `PiecewiseLinear::at` at jumps and beyond both ends.
  [[nodiscard]] vec4 operator()(const Real& s) const {
    vec4 optics = interpolated(s);
    if (Real(0) < units_per_length_) optics[3] = extinction_of(optics[3]);
    if (emission_ == Emission::plain) return optics;
    const Real extinction = optics[3];
    optics = extinction * optics;
    optics[3] = extinction;
    return optics;
  }

 private:
  [[nodiscard]] Real extinction_of(const Real& opacity) const {
    using std::log1p;
    return units_per_length_ * (opacity < Real(1) ? Real(-log1p(Real(-opacity))) : Real(opaque_extinction));
  }

  /// Colour, and extinction or opacity.
  [[nodiscard]] vec4 interpolated(const Real& s) const {
    const auto after =
        static_cast<std::size_t>(std::upper_bound(scalars_.begin(), scalars_.end(), s) - scalars_.begin());
    if (after == 0) return points_.front();
    if (after == scalars_.size()) return points_.back();
    const Real weight = (s - scalars_[after - 1]) / (scalars_[after] - scalars_[after - 1]);
    return points_[after - 1] + weight * (points_[after] - points_[after - 1]);
  }

  Emission emission_;
  Real units_per_length_ = Real(0);  ///< 0: the points hold extinctions
  std::vector<Real> scalars_;
  std::vector<vec4> points_;
};

}  // namespace raytruth
