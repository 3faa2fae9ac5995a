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

/// The optics of a knot, and its opacity where that is linear, as seen from below and from above.
struct Knot {
  double s;
  Optics below;
  Optics above;
  double opacity_below = 0;
  double opacity_above = 0;
};

std::vector<Knot> read_knots(const PiecewiseLinear& transfer) {
  std::vector<Knot> knots;
  const auto& opacities = transfer.opacities();
  for (std::size_t i = 0; i < transfer.points().size(); ++i) {
    const TransferPoint& point = transfer.points()[i];
    const double opacity = opacities.empty() ? 0 : opacities[i];
    if (!(point.optics.extinction <= largest) || !(point.optics.color <= largest).all())
      throw InputError(fmt::format("found an extinction or a color above 2^500 at s {}; less is allowed", point.s));
    if (!knots.empty() && knots.back().s == point.s) {
      knots.back().above = point.optics;
      knots.back().opacity_above = opacity;
      continue;
    }
    if (!knots.empty()) {
      const double distance = point.s - knots.back().s;
      if (!(distance >= smallest_distance && distance <= largest))
        throw InputError(fmt::format("found points at s {} and {}; distances from 2^-500 to 2^500 are allowed",
                                     knots.back().s, point.s));
    }
    knots.push_back({point.s, point.optics, point.optics, opacity, opacity});
  }
  return knots;
}

/// What is beyond one end of an interval: its optics there, `near` those of the neighbour at the same knot and `far` at
/// the neighbour's other end; `ratio` is the neighbour's width over the interval's.
///
/// Linear functions differ beyond the end by the difference of their slopes.
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

/// One side of an end: 1 - a there, how fast it falls away from the end per unit of x, and up to which distance.
struct OpacitySide {
  double clear = 1;
  double fall = 0;
  double reach = HUGE_VAL;

  /// The largest slope of -ln(1 - a) up to the reach.
  [[nodiscard]] double steepest() const { return 2 * std::abs(fall) / clear; }
};

/// 1 - a may fall to half of what it is at the end before anything else has to be known: -ln(1 - a) is no steeper than
/// twice there.
OpacitySide opacity_side(double clear, double clear_far, double width_in_x) {
  const double fall = (clear - clear_far) / width_in_x;
  return {clear, fall, fall > 0 ? clear / (2 * fall) : HUGE_VAL};
}

/// An end where the opacity is linear on at least one side: both functions differ by less than both slopes together.
void set_opacity_end(IntervalEnd& end, const OpacitySide& here, const OpacitySide& beyond, double units) {
  // The interval's own function goes on as it came, so it falls where it rose.
  const OpacitySide continued = opacity_side(here.clear, here.clear + here.fall, 1);
  for (const OpacitySide& side : {continued, beyond}) {
    if (side.clear > 0 || side.fall == 0) continue;
    const double slope = std::abs(side.fall) / slack;
    end.contact_slope = end.contact_slope > 0 ? std::min(end.contact_slope, slope) : slope;
  }
  if (here.clear > 0 && beyond.clear > 0) {
    end.extinction_kink = slack * units * (continued.steepest() + beyond.steepest());
    end.reach = std::min({end.reach, continued.reach / slack, beyond.reach / slack});
  } else {
    end.reach = 0;
  }
}

}  // namespace

LinearIntervals::LinearIntervals(const PiecewiseLinear& transfer) {
  const std::vector<Knot> knots = read_knots(transfer);
  const std::size_t count = knots.size();
  units_per_length_ = transfer.is_linear_in_opacity() ? 1 / transfer.unit_length() : 0;
  for (const Knot& knot : knots) {
    knots_.push_back(knot.s);
    has_opaque_points_ = has_opaque_points_ || knot.opacity_below == 1 || knot.opacity_above == 1;
    has_jumps_ = has_jumps_ || knot.below.extinction != knot.above.extinction ||
                 (knot.below.color != knot.above.color).any() || has_opaque_points_;
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
      interval.opacity.fill(knots.front().opacity_below);
    } else {
      interval.origin = interval.bottom = knots[i - 1].s;
      interval.top = i < count ? knots[i].s : interval.origin + span;
      interval.at_0 = knots[i - 1].above;
      interval.at_1 = i < count ? knots[i].below : knots[i - 1].above;
      interval.opacity = {knots[i - 1].opacity_above, i < count ? knots[i].opacity_below : knots[i - 1].opacity_above};
    }
    interval.is_linear =
        interval.at_0.extinction != interval.at_1.extinction || (interval.at_0.color != interval.at_1.color).any();
    interval.clear = {1 - interval.opacity[0], 1 - interval.opacity[1]};
    interval.is_opacity = interval.opacity[0] != interval.opacity[1];
    interval.is_opaque = interval.opacity[0] == 1 && interval.opacity[1] == 1;
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
      if (interval.is_opacity || below.is_opacity || interval.is_opaque || below.is_opaque)
        set_opacity_end(interval.end_0, opacity_side(interval.clear[0], interval.clear[1], 1),
                        opacity_side(below.clear[1], below.clear[0], width(i - 1) / width(i)), units_per_length_);
      interval.end_0.is_opaque_beyond = below.is_opaque;
      largest_optics(below.at_1);
    }
    if (i < count) {
      const LinearInterval& above = intervals_[i + 1];
      interval.end_1 = end_between(interval.at_0, interval.at_1, above.at_0, above.at_1, width(i + 1) / width(i));
      if (i + 1 == count) interval.end_1.reach = HUGE_VAL;
      if (interval.is_opacity || above.is_opacity || interval.is_opaque || above.is_opaque)
        set_opacity_end(interval.end_1, opacity_side(interval.clear[1], interval.clear[0], 1),
                        opacity_side(above.clear[0], above.clear[1], width(i + 1) / width(i)), units_per_length_);
      interval.end_1.is_opaque_beyond = above.is_opaque;
      largest_optics(above.at_0);
    }
    interval.typical_extinction = interval.most_extinction;
    if (units_per_length_ > 0) {
      interval.most_extinction = std::min(interval.most_extinction, most_mean_of_opaque * units_per_length_);
      interval.typical_extinction = std::min(interval.most_extinction, 4 * units_per_length_);
    }
  }
}

double LinearIntervals::most_extinction(double low, double high) const {
  // From the interval that ends at or above low to the one that begins at or below high: jumps count from both sides.
  const auto first = static_cast<std::size_t>(std::lower_bound(knots_.begin(), knots_.end(), low) - knots_.begin());
  const auto last = static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), high) - knots_.begin());
  double most = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const LinearInterval& interval = intervals_[i];
    const auto extinction_at = [&](double s) {
      if (!interval.is_opacity)
        return interval.is_opaque ? HUGE_VAL : std::max(interval.at_0.extinction, interval.at_1.extinction);
      const double x = std::clamp((s - interval.bottom) / (interval.top - interval.bottom), 0.0, 1.0);
      const double noise = 8 * 0x1p-53 * (1 + std::abs(s) / (interval.top - interval.bottom));
      const double clear = interval.clear[0] * (1 - x) + interval.clear[1] * x - noise;
      return clear > 0 ? slack * -std::log(clear) * units_per_length_ : HUGE_VAL;
    };
    most = std::max({most, extinction_at(low), extinction_at(high)});
  }
  return most;
}

}  // namespace raytruth
