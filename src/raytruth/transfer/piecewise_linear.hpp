#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/core/vector3.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace raytruth {

/// What a transfer function says of a scalar.
struct Optics {
  double extinction = 0;                                 ///< tau >= 0, per unit length
  Vector3<double> color = Vector3<double>::Constant(0);  ///< c >= 0, linear light
};

/// Optics at a scalar.
struct TransferPoint {
  double s = 0;
  Optics optics;
};

/// Opacity of a unit of length at a scalar, and the colour there.
struct OpacityPoint {
  double s = 0;
  double opacity = 0;  ///< 0 to 1
  Vector3<double> color = Vector3<double>::Constant(0);
};

/// A point of a list is not allowed where it stands.
struct PointError : InputError {
  PointError(std::size_t which, const std::string& message) : InputError(message), index(which) {}
  std::size_t index;
};

/// A transfer function that is linear between points and constant beyond both ends. Two points at one s are a jump: the
/// first is the value from the left; the second the value from the right and at s itself.
class PiecewiseLinear {
 public:
  /// Throws PointError unless there are points, all finite, sorted by s, at most two at one s, no extinction and no
  /// colour negative.
  explicit PiecewiseLinear(std::vector<TransferPoint> points);

  /// Optics at s.
  [[nodiscard]] Optics at(double s) const;

  [[nodiscard]] const std::vector<TransferPoint>& points() const { return points_; }

 private:
  std::vector<TransferPoint> points_;
};

/// Larger opacities are clamped to this: an opacity of 1 would need an infinite extinction.
inline constexpr double largest_opacity = 1 - 0x1p-12;

/// The transfer function of points that state the opacity a of a stretch of `unit_length`: tau = -ln(1 - a) /
/// unit_length. Linear opacity is not linear extinction, so every interval becomes 1024 linear ones, exact at their
/// ends. Opacities above `largest_opacity` are clamped after the interpolation. Throws PointError as PiecewiseLinear
/// does, and for opacities outside [0, 1]; InputError unless unit_length > 0.
PiecewiseLinear from_opacity(const std::vector<OpacityPoint>& points, double unit_length);

}  // namespace raytruth
