#include "raytruth/reference/linear_interval.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

constexpr double largest = 0x1p500;
constexpr double smallest_distance = 0x1p-500;
constexpr double slack = 1 + 0x1p-20;  // the rounding of the bounds below

/// The optics of a knot as seen from below and from above.
struct Knot {
  double s;
  Optics below;
  Optics above;
};

std::vector<Knot> read_knots(const PiecewiseLinear& transfer) {
  std::vector<Knot> knots;
  for (const TransferPoint& point : transfer.points()) {
    if (!(point.optics.extinction <= largest) || !(point.optics.color <= largest).all())
      throw InputError(fmt::format("found an extinction or a color above 2^500 at s {}; less is allowed", point.s));
    if (!knots.empty() && knots.back().s == point.s) {
      knots.back().above = point.optics;
      continue;
    }
    if (!knots.empty()) {
      const double distance = point.s - knots.back().s;
      if (!(distance >= smallest_distance && distance <= largest))
        throw InputError(fmt::format("found points at s {} and {}; distances from 2^-500 to 2^500 are allowed",
                                     knots.back().s, point.s));
    }
    knots.push_back({point.s, point.optics, point.optics});
  }
  return knots;
}

/// What is beyond one end of an interval: its optics there, `near` those of the neighbour at the same knot and `far` at
/// the neighbour's other end; `ratio` is the neighbour's width over the interval's.
IntervalEnd end_between(const Optics& beyond, const Optics& here, const Optics& near, const Optics& far, double ratio) {
  const auto channels = [](const Vector3<double>& x) { return x.abs().maxCoeff(); };
  IntervalEnd end;
  end.extinction_jump = slack * std::abs(near.extinction - here.extinction);
  end.color_jump = slack * channels(near.color - here.color);
  // Both slopes point away from the interval, per unit of its x.
  const double slope = here.extinction - beyond.extinction;
  const double next_slope = (far.extinction - near.extinction) / ratio;
  end.extinction_kink = slack * std::abs(next_slope - slope) + 0x1p-48 * (std::abs(slope) + std::abs(next_slope));
  const Vector3<double> color_slope = here.color - beyond.color;
  const Vector3<double> next_color_slope = (far.color - near.color) / ratio;
  end.color_kink =
      slack * channels(next_color_slope - color_slope) + 0x1p-48 * (channels(color_slope) + channels(next_color_slope));
  end.reach = ratio / slack;
  return end;
}

}  // namespace

LinearIntervals::LinearIntervals(const PiecewiseLinear& transfer) {
  const std::vector<Knot> knots = read_knots(transfer);
  const std::size_t count = knots.size();
  for (const Knot& knot : knots) {
    knots_.push_back(knot.s);
    has_jumps_ =
        has_jumps_ || knot.below.extinction != knot.above.extinction || (knot.below.color != knot.above.color).any();
    most_extinction_ = std::max({most_extinction_, knot.below.extinction, knot.above.extinction});
    most_color_ = std::max({most_color_, knot.below.color.maxCoeff(), knot.above.color.maxCoeff()});
  }
  // Half-lines get the width of the whole, so that x and the tests on it are of a reasonable size.
  const double span = count > 1 ? knots.back().s - knots.front().s : 1;
  const auto width = [&](std::size_t i) { return i == 0 || i == count ? span : knots[i].s - knots[i - 1].s; };
  for (std::size_t i = 0; i <= count; ++i) {
    LinearInterval interval;
    interval.scale = 1 / width(i);
    if (i == 0) {
      interval.origin = knots.front().s;
      interval.offset = 1;
      interval.bottom = interval.origin - span;
      interval.top = interval.origin;
      interval.at_0 = interval.at_1 = knots.front().below;
    } else {
      interval.origin = interval.bottom = knots[i - 1].s;
      interval.top = i < count ? knots[i].s : interval.origin + span;
      interval.at_0 = knots[i - 1].above;
      interval.at_1 = i < count ? knots[i].below : knots[i - 1].above;
    }
    interval.is_linear =
        interval.at_0.extinction != interval.at_1.extinction || (interval.at_0.color != interval.at_1.color).any();
    intervals_.push_back(interval);
  }
  for (std::size_t i = 0; i <= count; ++i) {
    LinearInterval& interval = intervals_[i];
    const auto largest_optics = [&](const Optics& optics) {
      interval.most_extinction = std::max(interval.most_extinction, optics.extinction);
      interval.most_color = std::max(interval.most_color, optics.color.maxCoeff());
    };
    largest_optics(interval.at_0);
    largest_optics(interval.at_1);
    interval.end_0.reach = interval.end_1.reach = HUGE_VAL;
    if (i > 0) {
      const LinearInterval& below = intervals_[i - 1];
      interval.end_0 = end_between(interval.at_1, interval.at_0, below.at_1, below.at_0, width(i - 1) / width(i));
      if (i == 1) interval.end_0.reach = HUGE_VAL;
      largest_optics(below.at_1);
    }
    if (i < count) {
      const LinearInterval& above = intervals_[i + 1];
      interval.end_1 = end_between(interval.at_0, interval.at_1, above.at_0, above.at_1, width(i + 1) / width(i));
      if (i + 1 == count) interval.end_1.reach = HUGE_VAL;
      largest_optics(above.at_0);
    }
  }
}

}  // namespace raytruth
