#include "raytruth/reference/arb/arb_stretches.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/reference/arb/arb_series.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace raytruth::arb {

namespace {

Color balls(const Vector3<double>& color) { return {color[0], color[1], color[2]}; }

/// value_a + weight (value_b - value_a).
Ball blend(double a, double b, const Ball& weight) { return Ball(a) + weight * (Ball(b) - Ball(a)); }

bool is_positive_or_zero(const Ball& x) { return arb_is_nonnegative(x.get()) != 0; }

/// Where in [begin, end] the monotone function f, of derivative `slope`, may be 0; `direction` is 1 where it rises: by
/// Newton's method on intervals, x - f(x) / f'([begin, end]), and by halves where that hardly helps. Nothing where f
/// certainly has no zero.
template <class Function>
std::optional<Ball> zero_of(const Function& f, const Polynomial& slope, int direction, const Ball& begin,
                            const Ball& end) {
  Ball bracket = hull(begin, end);
  const Ball close_enough = Ball(0x1p-100) * bracket.radius();
  for (;;) {
    const Ball middle = bracket.middle();
    const Ball gradient = slope(bracket);
    Ball next = bracket;
    if (gradient.sign() != 0) {
      const Ball newton = middle - f(middle) / gradient;
      if (arb_intersection(next.get(), newton.get(), bracket.get(), precision) == 0) return {};
    }
    if (!(next.radius() < Ball(0.5) * bracket.radius())) {
      // The zero may be in the middle itself: three points, of which at most one is that close to it.
      Ball low = bracket.lower();
      Ball high = bracket.upper();
      for (const double offset : {-0.5, 0.0, 0.5}) {
        const Ball x = (middle + offset * bracket.radius()).middle();
        const int sign = f(x).sign() * direction;
        if (sign < 0) low = x;
        if (sign > 0) high = min(high, x);
      }
      next = hull(low, high);
    }
    const bool is_stuck = !(next.radius() < Ball(0.875) * bracket.radius());
    bracket = next;
    if (is_stuck || bracket.radius() <= close_enough) return bracket;
  }
}

}  // namespace

PointsCut::PointsCut(const PiecewiseLinear& transfer) : unit_length_(transfer.unit_length()) {
  const auto& points = transfer.points();
  const auto opacity = [&](std::size_t i) { return transfer.is_linear_in_opacity() ? transfer.opacities()[i] : 0; };
  intervals_.push_back({points.front().optics, points.front().optics, opacity(0), opacity(0)});
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 < points.size() && points[i + 1].s == points[i].s) continue;
    const std::size_t next = std::min(i + 1, points.size() - 1);
    points_.push_back(points[i].s);
    intervals_.push_back({points[i].optics, points[next].optics, opacity(i), opacity(next)});
  }
}

Ball PointsCut::largest_color(const Ball& /*largest_signal*/) const {
  double largest = 0;
  for (const Interval& interval : intervals_)
    largest = std::max({largest, interval.begin.color.maxCoeff(), interval.end.color.maxCoeff()});
  return largest;
}

/// How many points are certainly <= s.
std::size_t PointsCut::points_below(const Ball& s) const {
  const auto end = std::partition_point(points_.begin(), points_.end(), [&](double point) { return Ball(point) <= s; });
  return static_cast<std::size_t>(end - points_.begin());
}

/// The one interval, a jump's right-hand value counting, that holds all control points; it may touch the next point,
/// where a polynomial that is not constant spends no time.
std::optional<std::size_t> PointsCut::common_interval(const std::vector<Ball>& control) const {
  const std::size_t interval = points_below(control.front());
  const auto is_inside = [&](const Ball& s) {
    return (interval == 0 || Ball(points_[interval - 1]) <= s) &&
           (interval == points_.size() || s <= Ball(points_[interval]));
  };
  if (std::all_of(control.begin(), control.end(), is_inside)) return interval;
  // The control points may also lie from a point downwards.
  const auto is_below = [&](const Ball& s) {
    return (interval == 1 || Ball(points_[interval - 2]) <= s) && s <= Ball(points_[interval - 1]);
  };
  if (interval > 0 && std::all_of(control.begin(), control.end(), is_below)) return interval - 1;
  return {};
}

void PointsCut::find_parts(const BallPiece& piece, const Ball& begin, const Ball& end, const std::vector<Ball>& control,
                           std::vector<Part>& parts) const {
  if (const auto interval = common_interval(control)) {
    parts.push_back({begin, end, interval});
    return;
  }
  bool rises = true;
  bool falls = true;
  for (std::size_t i = 1; i < control.size(); ++i) {
    const Ball difference = control[i] - control[i - 1];
    rises = rises && is_positive_or_zero(difference);
    falls = falls && is_positive_or_zero(-difference);
  }
  if (rises || falls) {
    cut_monotone(piece, begin, end, control.front(), control.back(), parts);
    return;
  }
  // Halving helps no more where the interval is tiny, or the signal varies no more than its rounding.
  constexpr double tiny = 0x1p-64;
  Ball lowest = control.front();
  Ball highest = control.front();
  Ball rounding;
  for (const Ball& s : control) {
    lowest = min(lowest, s.middle());
    highest = max(highest, s.middle());
    rounding = max(rounding, s.radius());
  }
  if (end - begin <= Ball(tiny) || highest - lowest <= Ball(8.0) * rounding) {
    parts.push_back({begin, end, {}});
    return;
  }
  std::vector<Ball> left = control;
  std::vector<Ball> right = control;
  for (std::size_t last = control.size() - 1; last > 0; --last) {
    left[control.size() - 1 - last] = right[0];
    for (std::size_t i = 0; i < last; ++i) right[i] = (right[i] + right[i + 1]) * 0.5;
  }
  left.back() = right[0];
  const Ball middle = (begin + end) * 0.5;
  find_parts(piece, begin, middle, left, parts);
  find_parts(piece, middle, end, right, parts);
}

/// A monotone stretch from the value `first` to `last`.
void PointsCut::cut_monotone(const BallPiece& piece, const Ball& begin, const Ball& end, const Ball& first,
                             const Ball& last, std::vector<Part>& parts) const {
  const Polynomial slope = piece.signal.derivative();
  const bool rises = first.middle() <= last.middle();
  const auto [low, high] = rises ? std::tie(first, last) : std::tie(last, first);
  const std::size_t lowest = points_below(low.lower());
  std::size_t highest = lowest;
  while (highest < points_.size() && !(high <= Ball(points_[highest]))) ++highest;
  Ball reached = begin;
  for (std::size_t i = lowest; i < highest; ++i) {
    const std::size_t point = rises ? i : highest - 1 - (i - lowest);
    const auto distance = [&](const Ball& x) { return piece.signal(x) - Ball(points_[point]); };
    const int direction = rises ? 1 : -1;
    Ball gap_begin = begin;
    Ball gap_end = end;
    if (const auto zero = zero_of(distance, slope, direction, begin, end)) {
      gap_begin = min(max(zero->lower(), begin), end);
      gap_end = min(max(zero->upper(), begin), end);
    } else if (distance(end).sign() == direction || distance(begin).sign() == direction) {
      gap_end = begin;  // by rounding alone the point seemed to lie inside
    } else if (distance(end).sign() != 0 || distance(begin).sign() != 0) {
      gap_begin = end;
    }
    gap_begin = max(reached, gap_begin);
    gap_end = max(gap_begin, gap_end);
    parts.push_back({reached, gap_begin, rises ? point : point + 1});
    parts.push_back({gap_begin, gap_end, {}});
    reached = gap_end;
  }
  parts.push_back({reached, end, rises ? highest : lowest});
}

BallStretch PointsCut::stretch_in(std::size_t interval, const BallPiece& piece, const Ball& begin,
                                  const Ball& end) const {
  const Optics& a = intervals_[interval].begin;
  const Optics& b = intervals_[interval].end;
  BallStretch stretch{.length = piece.length * (end - begin),
                      .extinction = a.extinction,
                      .weight = 0.0,
                      .color = balls(a.color),
                      .color_change = {}};
  // A constant opacity's extinction is a logarithm, which the transfer function holds rounded to binary64.
  if (unit_length_ > 0 && !intervals_[interval].is_opaque())
    stretch.extinction = Polynomial(-log(Ball(1.0) - Ball(intervals_[interval].opacity_begin)) / Ball(unit_length_));
  const bool is_constant = a.extinction == b.extinction && (a.color == b.color).all();
  if (is_constant) return stretch;
  const Ball width = Ball(points_[interval]) - Ball(points_[interval - 1]);
  stretch.weight = Ball(1.0) / width * (piece.signal.restricted(begin, end) - Polynomial(points_[interval - 1]));
  if (a.extinction != b.extinction)
    stretch.extinction = Polynomial(a.extinction) + (Ball(b.extinction) - Ball(a.extinction)) * stretch.weight;
  for (std::size_t i = 0; i < 3; ++i)
    stretch.color_change[i] = Ball(b.color[static_cast<Eigen::Index>(i)]) - Ball(a.color[static_cast<Eigen::Index>(i)]);
  return stretch;
}

BallStretch PointsCut::stretch_across(const BallPiece& piece, const Ball& begin, const Ball& end) const {
  const Ball s = piece.signal(hull(begin, end));
  const Ball low = s.lower();
  const Ball high = s.upper();
  const Ball length = piece.length * (end - begin);
  Ball extinction;
  Ball most_depth;
  // Where 1 - a may vanish the mean of -ln(1 - a) is still below 2048, on 2^-110 of a piece and for degrees up to 9.
  const auto depth_of = [&](const Interval& interval, const Ball& weight) -> Ball {
    if (interval.is_opaque()) return opaque_depth;
    const Ball clear = blend(1 - interval.opacity_begin, 1 - interval.opacity_end, weight).lower();
    const Ball most = clear.sign() > 0 ? max(0.0, -log(clear)) : Ball(2048.0);
    return length / Ball(unit_length_) * most;
  };
  Color color;
  std::size_t i = points_below(low);
  // From a point's own value on downwards the left-hand value of a jump counts too.
  if (i > 0 && low <= Ball(points_[i - 1])) --i;
  for (bool is_first = true;; is_first = false, ++i) {
    const Optics& a = intervals_[i].begin;
    const Optics& b = intervals_[i].end;
    Ball weight;
    if (i > 0 && i < points_.size()) {
      const Ball p = points_[i - 1];
      const Ball q = points_[i];
      weight = (hull(min(max(low, p), q), min(max(high, p), q)) - p) / (q - p);
    }
    const auto extend = [is_first](Ball& sum, const Ball& value) { sum = is_first ? value : hull(sum, value); };
    extend(extinction, blend(a.extinction, b.extinction, weight));
    if (unit_length_ > 0) most_depth = max(most_depth, depth_of(intervals_[i], weight));
    for (Eigen::Index k = 0; k < 3; ++k)
      extend(color[static_cast<std::size_t>(k)], blend(a.color[k], b.color[k], weight));
    if (i == points_.size() || high < Ball(points_[i])) break;
  }
  BallStretch stretch{.length = length, .extinction = extinction, .weight = 0.0, .color = color, .color_change = {}};
  if (unit_length_ > 0) stretch.depth = hull(0.0, most_depth);
  return stretch;
}

/// The stretch on which the ray ends: the colour is that at its beginning, whatever little shines in a gap before.
void PointsCut::visit_opaque(std::size_t interval, const BallPiece& piece, const Ball& begin, const Ball& end,
                             const Visit& visit) const {
  const Ball little = 0x1p-80;
  BallStretch stretch = stretch_in(interval, piece, begin, end);
  const Ball weight = stretch.weight(Ball(0.0));
  for (std::size_t i = 0; i < 3; ++i) {
    const Ball color = stretch.color[i] + stretch.color_change[i] * weight;
    stretch.color[i] = widened(color, little * (color.magnitude() + stretch.color_change[i].magnitude()));
  }
  stretch.color_change = {};
  stretch.depth = opaque_depth;
  visit(stretch);
}

void PointsCut::visit_opacity(std::size_t interval, const BallPiece& piece, const Ball& begin, const Ball& end,
                              const Visit& visit) const {
  const Ball largest_remainder = 0x1p-72;
  const Ball narrowest = 0x1p-64;
  const auto& [a, b, opacity_begin, opacity_end] = intervals_[interval];
  const Ball width = Ball(points_[interval]) - Ball(points_[interval - 1]);
  const Ball slope = (Ball(opacity_begin) - Ball(opacity_end)) / width;
  // 1 - a, exact but for the balls' rounding. In the coordinate of the part, for powers of another would hide by how
  // little it varies; of 1 - a and not of the signal, so that what vanishes stays exact.
  const Polynomial signal = piece.signal - Polynomial(points_[interval - 1]);
  const Polynomial clear = (Polynomial(Ball(1.0) - Ball(opacity_begin)) + slope * signal).restricted(begin, end);
  const auto is_zero = [](const Ball& x) { return arb_is_zero(x.get()) != 0; };
  bool vanishes = true;
  for (slong k = 0; k < clear.size(); ++k) vanishes = vanishes && is_zero(clear.coefficient(k));
  if (vanishes) {
    visit_opaque(interval, piece, begin, end, visit);
    return;
  }
  const auto extinction = [&](const Series& x) {
    Series series(Polynomial(), x.order());
    for (slong k = clear.size() - 1; k >= 0; --k) series = clear.coefficient(k) + series * x;
    return Ball(-1.0) / Ball(unit_length_) * log(series);
  };
  BallStretch stretch{.length = piece.length * (end - begin),
                      .extinction = {},
                      .weight = Ball(1.0) / width * signal.restricted(begin, end),
                      .color = balls(a.color),
                      .color_change = {}};
  for (std::size_t i = 0; i < 3; ++i)
    stretch.color_change[i] = Ball(b.color[static_cast<Eigen::Index>(i)]) - Ball(a.color[static_cast<Eigen::Index>(i)]);
  if (auto model = taylor_model(extinction, 0.0, 1.0, largest_remainder / Ball(unit_length_))) {
    stretch.extinction = std::move(*model);
    visit(stretch);
    return;
  }
  const bool is_noise = clear.magnitude() <= Ball(8.0) * clear.error();
  if (end - begin <= narrowest || is_noise) {
    const Ball most = max(0.0, min(1.0, clear(hull(Ball(0.0), Ball(1.0))).upper()));
    const Ball seen = max(clear(Ball(0.0)).lower(), clear(Ball(1.0)).lower());
    const Ball units = stretch.length / Ball(unit_length_);
    const Ball least_depth = most.sign() > 0 ? Ball(max(0.0, -log(most) * units)) : Ball(opaque_depth);
    const Ball degree = static_cast<double>(clear.size() - 1);
    const Ball most_depth =
        seen.sign() > 0 ? units * (max(0.0, -log(seen)) + Ball(1.2785) * degree) : Ball(opaque_depth);
    stretch.depth = hull(least_depth, max(least_depth, most_depth));
    visit(stretch);
    return;
  }
  const Ball middle = ((begin + end) * 0.5).middle();
  visit_opacity(interval, piece, begin, middle, visit);
  visit_opacity(interval, piece, middle, end, visit);
}

void PointsCut::visit_part(const std::optional<std::size_t>& interval, const BallPiece& piece, const Ball& begin,
                           const Ball& end, const Visit& visit) const {
  if (!interval) {
    visit(stretch_across(piece, begin, end));
  } else if (intervals_[*interval].is_opaque()) {
    visit_opaque(*interval, piece, begin, end, visit);
  } else if (intervals_[*interval].opacity_begin != intervals_[*interval].opacity_end) {
    visit_opacity(*interval, piece, begin, end, visit);
  } else {
    visit(stretch_in(*interval, piece, begin, end));
  }
}

void PointsCut::operator()(const BallPiece& piece, const Visit& visit) const {
  std::vector<Part> parts;
  find_parts(piece, 0.0, 1.0, piece.control, parts);
  // What a chain's rounding leaves behind the last coefficient.
  if (!(piece.end <= Ball(1.0))) parts.push_back({1.0, max(1.0, piece.end), {}});
  const auto is_opaque = [this](const Part& part) { return part.interval && intervals_[*part.interval].is_opaque(); };
  for (std::size_t i = 0; i < parts.size();) {
    const std::size_t first = i;
    while (++i < parts.size() && parts[i].interval == parts[first].interval) {
    }
    const Ball begin = min(parts[first].begin, piece.end);
    const Ball end = i == parts.size() ? piece.end : min(parts[i - 1].end, piece.end);
    if (end <= begin) continue;
    // A ray that becomes opaque somewhere in a gap does so at its front, as far as any ball can tell.
    const bool ends_here = !parts[first].interval && i < parts.size() && is_opaque(parts[i]) &&
                           parts[i].begin < min(parts[i].end, piece.end);
    if (ends_here) {
      visit_opaque(*parts[i].interval, piece, begin, end, visit);
      return;
    }
    visit_part(parts[first].interval, piece, begin, end, visit);
  }
}

GaussianCut::GaussianCut(const GaussianTransfer& transfer) : transfer_(transfer) {
  if (!(transfer.deviation > 0))
    throw InputError(fmt::format("found deviation {}; a number > 0 is allowed", transfer.deviation));
}

Ball GaussianCut::largest_color(const Ball& largest_signal) const {
  return Ball(transfer_.color.abs().maxCoeff()) + largest_signal * Ball(transfer_.color_slope.abs().maxCoeff());
}

void GaussianCut::cut(const BallPiece& piece, const Ball& begin, const Ball& end, const Visit& visit) const {
  const Ball largest_remainder = Ball(0x1p-72) * Ball(transfer_.extinction);
  const Ball narrowest = 0x1p-30;
  const Ball width = Ball(transfer_.deviation) * Ball(transfer_.deviation) * 2.0;
  const auto extinction = [&](const Series& x) {
    Series s(Polynomial(), x.order());
    for (slong k = piece.signal.size() - 1; k >= 0; --k) s = piece.signal.coefficient(k) + s * x;
    const Series distance = Ball(-transfer_.mean) + s;
    return Ball(transfer_.extinction) * exp(Ball(-1.0) / width * (distance * distance));
  };
  const bool is_narrow = end - begin <= narrowest;
  if (auto model =
          taylor_model(extinction, begin, end, is_narrow ? std::nullopt : std::optional<Ball>(largest_remainder))) {
    visit({.length = piece.length * (end - begin),
           .extinction = std::move(*model),
           .weight = piece.signal.restricted(begin, end),
           .color = balls(transfer_.color),
           .color_change = balls(transfer_.color_slope)});
    return;
  }
  const Ball middle = ((begin + end) * 0.5).middle();
  cut(piece, begin, middle, visit);
  cut(piece, middle, end, visit);
}

}  // namespace raytruth::arb
