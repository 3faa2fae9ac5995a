#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <algorithm>
#include <vector>

namespace raytruth {

/// A transfer function as a renderer looks it up, in any arithmetic: the scalar's emission density q (three channels)
/// and its extinction tau. Points are rounded to Real, everything in between is computed in it.
template <class Real>
class OpticsLookup {
 public:
  using vec4 = typename Rules<Real>::vec4;

  OpticsLookup(const PiecewiseLinear& transfer, Emission emission) : emission_(emission) {
    for (const TransferPoint& point : transfer.points()) {
      const auto& [extinction, color] = point.optics;
      scalars_.emplace_back(point.s);
      points_.push_back(vec4(Real(color[0]), Real(color[1]), Real(color[2]), Real(extinction)));
    }
  }

  /// q and tau at s; as `PiecewiseLinear::at` at jumps and beyond both ends.
  [[nodiscard]] vec4 operator()(const Real& s) const {
    vec4 optics = color_and_extinction(s);
    if (emission_ == Emission::plain) return optics;
    const Real extinction = optics[3];
    optics = extinction * optics;
    optics[3] = extinction;
    return optics;
  }

 private:
  [[nodiscard]] vec4 color_and_extinction(const Real& s) const {
    const auto after =
        static_cast<std::size_t>(std::upper_bound(scalars_.begin(), scalars_.end(), s) - scalars_.begin());
    if (after == 0) return points_.front();
    if (after == scalars_.size()) return points_.back();
    const Real weight = (s - scalars_[after - 1]) / (scalars_[after] - scalars_[after - 1]);
    return points_[after - 1] + weight * (points_[after] - points_[after - 1]);
  }

  Emission emission_;
  std::vector<Real> scalars_;
  std::vector<vec4> points_;
};

}  // namespace raytruth
