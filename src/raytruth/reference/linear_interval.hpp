#pragma once

#include "raytruth/transfer/piecewise_linear.hpp"

#include <vector>

namespace raytruth {

/// What happens where the scalar leaves an interval through one of its ends: how wrong the interval's linear functions,
/// continued, can be there.
struct IntervalEnd {
  double extinction_jump = 0;
  double extinction_kink = 0;  ///< per unit of x
  double color_jump = 0;       ///< largest channel
  double color_kink = 0;
  double reach = 0;  ///< x may leave [0, 1] by this much before the neighbour ends too
};

/// An interval of scalars on which a transfer function is linear, in the normalised scalar x = offset + scale (s -
/// origin), 0 at its lower end and 1 at its upper one. The two half-lines beyond the points are intervals too, constant
/// ones.
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
  double most_extinction = 0;  ///< here and just beyond both ends
  double most_color = 0;
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

  [[nodiscard]] bool has_jumps() const { return has_jumps_; }
  [[nodiscard]] double most_extinction() const { return most_extinction_; }
  [[nodiscard]] double most_color() const { return most_color_; }

 private:
  std::vector<double> knots_;
  std::vector<LinearInterval> intervals_;
  bool has_jumps_ = false;
  double most_extinction_ = 0;
  double most_color_ = 0;
};

}  // namespace raytruth
