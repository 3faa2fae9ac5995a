#pragma once

#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace raytruth {

/// The largest mean of -ln(1 - a) that is reckoned with over a part of a stretch where a, linear in the scalar, comes
/// to
/// 1. Over a share v of it, and degree n, the mean is at most n (2 + ln(1 / v)) - ln(max (1 - a)): more than this takes
/// a share below 2^-100 of a stretch, or one on which 1 - a is nowhere above 2^-500.
inline constexpr double most_mean_of_opaque = 1024;

/// What happens where the scalar leaves an interval through one of its ends: how wrong the interval's linear functions,
/// continued, can be there.
struct IntervalEnd {
  double extinction_jump = 0;
  double extinction_kink = 0;  ///< per unit of x
  double color_jump = 0;       ///< largest channel
  double color_kink = 0;
  double reach = 0;  ///< x may leave [0, 1] by this much before the neighbour ends too, or -ln(1 - a) doubles its slope
  /// Where the opacity is 1 at this end, on either side of it, though on no stretch: |d(1 - a)/dx|, the least one.
  /// There the extinction has no bound, but a mean that has.
  double contact_slope = 0;
  bool is_opaque_beyond = false;  ///< the neighbour's opacity is 1 throughout
};

/// An interval of scalars on which a transfer function is linear, its colour and either extinction or opacity, in the
/// normalised scalar x = offset + scale (s - origin), 0 at its lower end and 1 at its upper one. The two half-lines
/// beyond the points are intervals too, constant ones.
struct LinearInterval {
  double origin = 0;
  double scale = 1;
  double offset = 0;
  double bottom = 0;      ///< where x is 0
  double top = 0;         ///< where x is 1
  bool is_linear = true;  ///< else constant, whatever x is
  Optics at_0;
  Optics at_1;
  IntervalEnd end_0;
  IntervalEnd end_1;
  double most_extinction = 0;     ///< here and just beyond both ends; the largest mean where the opacity is 1
  double typical_extinction = 0;  ///< the same, but no more than a few for a unit of opacity
  double most_color = 0;
  // Where the opacity is linear:
  bool is_opacity = false;          ///< and not constant
  std::array<double, 2> opacity{};  ///< at x = 0 and 1
  std::array<double, 2> clear{};    ///< 1 less that
  bool is_opaque = false;           ///< the opacity is 1 throughout
};

/// A transfer function as intervals, made once and used for many rays.
class LinearIntervals {
 public:
  /// Throws InputError for points closer together than 2^-500 or farther apart than 2^500, and for extinctions and
  /// colours above 2^500: products of such numbers leave the range of binary64.
  explicit LinearIntervals(const PiecewiseLinear& transfer);

  /// The different scalars of the points, ascending. Interval i lies between knots i - 1 and i.
  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }
  [[nodiscard]] const LinearInterval& operator[](std::size_t interval) const { return intervals_[interval]; }

  /// Whether places have to be told to their last bit: at jumps, and where the opacity becomes 1.
  [[nodiscard]] bool has_jumps() const { return has_jumps_; }

  /// 1 over the length that opacities are of; 0 where the extinction is linear.
  [[nodiscard]] double units_per_length() const { return units_per_length_; }

  /// Whether the opacity is 1 anywhere, so that the extinction has no bound.
  [[nodiscard]] bool has_opaque_points() const { return has_opaque_points_; }

  /// The largest extinction of the scalars from low to high; infinite if the opacity is 1 at one of them.
  [[nodiscard]] double most_extinction(double low, double high) const;
  [[nodiscard]] double most_extinction() const { return most_extinction_; }
  [[nodiscard]] double most_color() const { return most_color_; }

  /// Whether nothing absorbs, and in plain emission nothing shines, in an interval; and at any scalar from low to high.
  [[nodiscard]] bool is_dark(std::size_t interval, Emission emission) const;
  [[nodiscard]] bool are_dark(double low, double high, Emission emission) const;

  /// The largest `scale` of an interval.
  [[nodiscard]] double largest_scale() const { return largest_scale_; }

 private:
  /// From the interval that ends at or above low to the one that begins at or below high: jumps count from both sides.
  [[nodiscard]] std::pair<std::size_t, std::size_t> reached(double low, double high) const;

  std::vector<double> knots_;
  std::vector<LinearInterval> intervals_;
  bool has_jumps_ = false;
  bool has_opaque_points_ = false;
  double units_per_length_ = 0;
  double most_extinction_ = 0;
  double most_color_ = 0;
  double largest_scale_ = 0;
};

}  // namespace raytruth
