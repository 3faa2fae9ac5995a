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

/// Interval i, between knots i - 1 and i. Half-lines get the width of the whole, `span`, so that x and the tests on it
/// are of a reasonable size.
LinearInterval interval_between(const std::vector<Knot>& knots, std::size_t i, double span) {
  const bool is_last = i == knots.size();
  LinearInterval interval;
  if (i == 0) {
    const Knot& first = knots.front();
    interval.scale = 1 / span;
    interval.origin = first.s;
    interval.offset = 1;
    interval.bottom = interval.origin - span;
    interval.top = interval.origin;
    interval.at_0 = interval.at_1 = first.below;
    interval.opacity.fill(first.opacity_below);
  } else {
    const Knot& low = knots[i - 1];
    interval.scale = 1 / (is_last ? span : knots[i].s - low.s);
    interval.origin = interval.bottom = low.s;
    interval.top = is_last ? interval.origin + span : knots[i].s;
    interval.at_0 = low.above;
    interval.at_1 = is_last ? low.above : knots[i].below;
    interval.opacity = {low.opacity_above, is_last ? low.opacity_above : knots[i].opacity_below};
  }
  interval.is_linear =
      interval.at_0.extinction != interval.at_1.extinction || (interval.at_0.color != interval.at_1.color).any();
  interval.clear = {1 - interval.opacity[0], 1 - interval.opacity[1]};
  interval.is_opacity = interval.opacity[0] != interval.opacity[1];
  interval.is_opaque = interval.opacity[0] == 1 && interval.opacity[1] == 1;
  return interval;
}

/// The end of an interval beyond which `neighbour` is, a half-line if it `is_half_line`; `end` is 0 or 1, `ratio` the
/// neighbour's width over the interval's.
IntervalEnd end_towards(const LinearInterval& interval, std::size_t end, const LinearInterval& neighbour,
                        bool is_half_line, double ratio, double units) {
  const auto optics = [](const LinearInterval& of, std::size_t at) -> const Optics& {
    return at == 0 ? of.at_0 : of.at_1;
  };
  const std::size_t other = 1 - end;
  IntervalEnd result = end_between(optics(interval, other), optics(interval, end), optics(neighbour, other),
                                   optics(neighbour, end), ratio);
  if (is_half_line) result.reach = HUGE_VAL;
  if (interval.is_opacity || neighbour.is_opacity || interval.is_opaque || neighbour.is_opaque)
    set_opacity_end(result, opacity_side(interval.clear[end], interval.clear[other], 1),
                    opacity_side(neighbour.clear[other], neighbour.clear[end], ratio), units);
  result.is_opaque_beyond = neighbour.is_opaque;
  return result;
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
  const double span = count > 1 ? knots.back().s - knots.front().s : 1;
  const auto width = [&](std::size_t i) { return i == 0 || i == count ? span : knots[i].s - knots[i - 1].s; };
  for (std::size_t i = 0; i <= count; ++i) intervals_.push_back(interval_between(knots, i, span));
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
      interval.end_0 = end_towards(interval, 0, intervals_[i - 1], i == 1, width(i - 1) / width(i), units_per_length_);
      largest_optics(intervals_[i - 1].at_1);
    }
    if (i < count) {
      interval.end_1 =
          end_towards(interval, 1, intervals_[i + 1], i + 1 == count, width(i + 1) / width(i), units_per_length_);
      largest_optics(intervals_[i + 1].at_0);
    }
    largest_scale_ = std::max(largest_scale_, interval.scale);
    interval.typical_extinction = interval.most_extinction;
    if (units_per_length_ > 0) {
      interval.most_extinction = std::min(interval.most_extinction, most_mean_of_opaque * units_per_length_);
      interval.typical_extinction = std::min(interval.most_extinction, 4 * units_per_length_);
    }
  }
}

std::pair<std::size_t, std::size_t> LinearIntervals::reached(double low, double high) const {
  return {static_cast<std::size_t>(std::lower_bound(knots_.begin(), knots_.end(), low) - knots_.begin()),
          static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), high) - knots_.begin())};
}

bool LinearIntervals::is_dark(std::size_t interval, Emission emission) const {
  const auto is_dark_at = [emission](const Optics& optics) {
    return optics.extinction == 0 && (emission == Emission::associated || (optics.color == 0).all());
  };
  return is_dark_at(intervals_[interval].at_0) && is_dark_at(intervals_[interval].at_1);
}

bool LinearIntervals::are_dark(double low, double high, Emission emission) const {
  const auto [first, last] = reached(low, high);
  for (std::size_t i = first; i <= last; ++i)
    if (!is_dark(i, emission)) return false;
  return true;
}

double LinearIntervals::most_extinction(double low, double high) const {
  const auto [first, last] = reached(low, high);
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
