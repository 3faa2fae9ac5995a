#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/core/vector3.hpp"

#include <cstddef>
#include <string>
#include <string_view>
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

/// A transfer function between points, constant beyond both ends. Between two points the colour is linear in s, and so
/// is either the extinction or the opacity a of a unit of length, tau = -ln(1 - a) / unit_length (`from_opacity`),
/// which is what renderers interpolate. Two points at one s are a jump: the first is the value from the left; the
/// second the value from the right and at s itself.
class PiecewiseLinear {
 public:
  /// Linear in extinction. Throws PointError unless there are points, all finite, sorted by s, at most two at one s, no
  /// extinction and no colour negative.
  explicit PiecewiseLinear(std::vector<TransferPoint> points);

  /// Optics at s. Opacity 1 counts as `opaque_extinction` over the unit of length.
  [[nodiscard]] Optics at(double s) const;

  /// Optics at s as they are from below: at a jump those on its left.
  [[nodiscard]] Optics before(double s) const;

  /// The opacity of a unit of length at s, and from below. Only for functions that are linear in it.
  [[nodiscard]] double opacity_at(double s) const;
  [[nodiscard]] double opacity_before(double s) const;

  /// The points; where the opacity is linear their extinction is that of their opacity, as `at` tells it.
  [[nodiscard]] const std::vector<TransferPoint>& points() const { return points_; }

  /// Whether the opacity is linear between the points, not the extinction.
  [[nodiscard]] bool is_linear_in_opacity() const { return !opacities_.empty(); }

  /// The opacity of every point, and the length that it is of. Empty and 0 where the extinction is linear.
  [[nodiscard]] const std::vector<double>& opacities() const { return opacities_; }
  [[nodiscard]] double unit_length() const { return unit_length_; }

 private:
  /// One of the points, or between two of them.
  struct Place {
    std::size_t from;
    std::size_t to;
    double weight;
  };
  [[nodiscard]] Place place_of(double s) const;
  [[nodiscard]] Place place_before(double s) const;
  [[nodiscard]] Optics optics_at(const Place& place) const;
  [[nodiscard]] double opacity_at(const Place& place) const;

  friend PiecewiseLinear from_opacity(const std::vector<OpacityPoint>& points, double unit_length);

  std::vector<TransferPoint> points_;
  std::vector<double> opacities_;
  double unit_length_ = 0;
};

/// What stands for the depth of a unit of length of opacity 1 where a number has to be finite: it lets nothing through
/// that is longer than 2^-90 units. The reference integrals do without it.
inline constexpr double opaque_extinction = 0x1p100;

/// The transfer function of points that state the opacity a of a length `unit_length`, exactly: a is linear between
/// them, tau = -ln(1 - a) / unit_length. Where a is 1 at a single scalar, a ray that only meets it has a finite optical
/// depth; where it is 1 on an interval, the ray ends. Throws PointError as PiecewiseLinear does, and for opacities
/// outside [0, 1]; InputError unless unit_length > 0.
PiecewiseLinear from_opacity(const std::vector<OpacityPoint>& points, double unit_length);

/// The transfer function on [low, high], constant beyond at what it is at the two ends, low from above and high from
/// below.
PiecewiseLinear clamped(const PiecewiseLinear& transfer, double low, double high);

/// The transfer function, all white.
PiecewiseLinear whitened(const PiecewiseLinear& transfer);

/// Opacities above this are clamped to it by `linear_in_extinction`: opacity 1 would need an infinite extinction.
inline constexpr double largest_opacity = 1 - 0x1p-12;

/// The transfer function for methods that need an extinction that is linear between points: one that is so already as
/// it is; else every interval in which the opacity changes becomes up to 1024 linear ones, exact at their ends, fewer
/// where there are more than 64 of them (2^16 in all, but no interval less than 8). Opacities above `largest_opacity`
/// are clamped to it. An approximation, to some 10^-6 of the opacity: who uses it says so. The reference and the exact
/// schemes do not.
PiecewiseLinear linear_in_extinction(const PiecewiseLinear& transfer);

/// What to tell a user whose transfer function has been through `linear_in_extinction`.
inline constexpr std::string_view sampled_opacity =
    "its opacity, linear between points, is taken as linear pieces of extinction, up to 1024 for an interval, and "
    "opacities above 1 - 2^-12 as that";

}  // namespace raytruth
