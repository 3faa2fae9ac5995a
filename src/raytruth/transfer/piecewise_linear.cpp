#include "raytruth/transfer/piecewise_linear.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

constexpr int most_intervals_of_one = 1024;
constexpr int least_intervals_of_one = 8;
constexpr int most_intervals = 1 << 16;

/// Refuses points out of order and colours that are no light.
template <class Point, class ColorOf>
void check_points(const std::vector<Point>& points, ColorOf color_of) {
  if (points.empty()) throw InputError("found no points; at least one point is allowed");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double s = points[i].s;
    if (!std::isfinite(s)) throw PointError(i, fmt::format("found s {}; a finite number is allowed", s));
    const Vector3<double> color = color_of(points[i]);
    if (!(color >= 0).all() || !color.isFinite().all())
      throw PointError(
          i, fmt::format("found color [{}, {}, {}]; finite numbers >= 0 are allowed", color[0], color[1], color[2]));
    if (i > 0 && s < points[i - 1].s)
      throw PointError(i, fmt::format("found s {} after {}; points sorted by s are allowed", s, points[i - 1].s));
    if (i > 1 && s == points[i - 2].s)
      throw PointError(i, fmt::format("found a third point at s {}; at most two are allowed", s));
  }
}

/// Where s lies between two points: 0 at a, 1 at b. Scalars are halved first: the distance of two may overflow.
double weight_between(double a, double b, double s) { return (s / 2 - a / 2) / (b / 2 - a / 2); }

/// -ln(1 - a) / unit_length of the opacity a between two others. Both a and 1 - a are told to a rounding of themselves.
double extinction_between(double a, double b, double weight, double unit_length) {
  const double opacity = std::lerp(a, b, weight);
  const double clear = std::lerp(1 - a, 1 - b, weight);
  if (!(clear > 0)) return opaque_extinction / unit_length;
  return std::min(opacity < 0.5 ? -std::log1p(-opacity) : -std::log(clear), opaque_extinction) / unit_length;
}

std::vector<OpacityPoint> opacity_points(const std::vector<TransferPoint>& points,
                                         const std::vector<double>& opacities) {
  std::vector<OpacityPoint> result;
  for (std::size_t i = 0; i < points.size(); ++i) result.push_back({points[i].s, opacities[i], points[i].optics.color});
  return result;
}

}  // namespace

PiecewiseLinear::PiecewiseLinear(std::vector<TransferPoint> points) : points_(std::move(points)) {
  check_points(points_, [](const TransferPoint& point) { return point.optics.color; });
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double extinction = points_[i].optics.extinction;
    if (!(extinction >= 0) || !std::isfinite(extinction))
      throw PointError(i, fmt::format("found extinction {}; a finite number >= 0 is allowed", extinction));
  }
}

PiecewiseLinear::Place PiecewiseLinear::place_of(double s) const {
  const auto after = std::upper_bound(points_.begin(), points_.end(), s,
                                      [](double x, const TransferPoint& point) { return x < point.s; });
  const auto index = static_cast<std::size_t>(after - points_.begin());
  if (index == 0) return {0, 0, 0};
  if (index == points_.size() || points_[index - 1].s == s) return {index - 1, index - 1, 0};
  return {index - 1, index, weight_between(points_[index - 1].s, points_[index].s, s)};
}

PiecewiseLinear::Place PiecewiseLinear::place_before(double s) const {
  const auto not_before = std::lower_bound(points_.begin(), points_.end(), s,
                                           [](const TransferPoint& point, double x) { return point.s < x; });
  if (not_before == points_.end() || not_before->s != s) return place_of(s);
  const auto index = static_cast<std::size_t>(not_before - points_.begin());
  return {index, index, 0};
}

Optics PiecewiseLinear::optics_at(const Place& place) const {
  const auto& [from, to, weight] = place;
  const Optics& a = points_[from].optics;
  const Optics& b = points_[to].optics;
  if (from == to) return a;
  return {is_linear_in_opacity() ? extinction_between(opacities_[from], opacities_[to], weight, unit_length_)
                                 : std::lerp(a.extinction, b.extinction, weight),
          a.color + weight * (b.color - a.color)};
}

double PiecewiseLinear::opacity_at(const Place& place) const {
  return std::lerp(opacities_[place.from], opacities_[place.to], place.weight);
}

Optics PiecewiseLinear::at(double s) const { return optics_at(place_of(s)); }
Optics PiecewiseLinear::before(double s) const { return optics_at(place_before(s)); }
double PiecewiseLinear::opacity_at(double s) const { return opacity_at(place_of(s)); }
double PiecewiseLinear::opacity_before(double s) const { return opacity_at(place_before(s)); }

PiecewiseLinear from_opacity(const std::vector<OpacityPoint>& points, double unit_length) {
  check_points(points, [](const OpacityPoint& point) { return point.color; });
  if (!(unit_length > 0) || !std::isfinite(unit_length))
    throw InputError(fmt::format("found unit_length {}; a finite number > 0 is allowed", unit_length));
  std::vector<TransferPoint> converted;
  std::vector<double> opacities;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [s, opacity, color] = points[i];
    if (!(opacity >= 0 && opacity <= 1))
      throw PointError(i, fmt::format("found opacity {}; a number from 0 to 1 is allowed", opacity));
    converted.push_back({s, {extinction_between(opacity, opacity, 0, unit_length), color}});
    opacities.push_back(opacity);
  }
  PiecewiseLinear transfer(std::move(converted));
  transfer.opacities_ = std::move(opacities);
  transfer.unit_length_ = unit_length;
  return transfer;
}

PiecewiseLinear clamped(const PiecewiseLinear& transfer, double low, double high) {
  std::vector<TransferPoint> points{{low, transfer.at(low)}};
  std::vector<double> opacities;
  const auto& all = transfer.opacities();
  if (!all.empty()) opacities.push_back(transfer.opacity_at(low));
  for (std::size_t i = 0; i < transfer.points().size(); ++i) {
    const TransferPoint& point = transfer.points()[i];
    if (!(low < point.s && point.s < high)) continue;
    points.push_back(point);
    if (!all.empty()) opacities.push_back(all[i]);
  }
  // A jump at the upper end is met only from below, but for the end itself, which has no extent.
  points.push_back({high, transfer.before(high)});
  if (all.empty()) return PiecewiseLinear(std::move(points));
  opacities.push_back(transfer.opacity_before(high));
  return from_opacity(opacity_points(points, opacities), transfer.unit_length());
}

PiecewiseLinear whitened(const PiecewiseLinear& transfer) {
  std::vector<TransferPoint> points = transfer.points();
  for (TransferPoint& point : points) point.optics.color = {1, 1, 1};
  if (!transfer.is_linear_in_opacity()) return PiecewiseLinear(std::move(points));
  return from_opacity(opacity_points(points, transfer.opacities()), transfer.unit_length());
}

PiecewiseLinear linear_in_extinction(const PiecewiseLinear& transfer) {
  if (!transfer.is_linear_in_opacity()) return transfer;
  const auto& points = transfer.points();
  const auto& opacities = transfer.opacities();
  const auto changes_before = [&](std::size_t i) {
    return i > 0 && points[i - 1].s < points[i].s && opacities[i - 1] != opacities[i];
  };
  int changing = 0;
  for (std::size_t i = 0; i < points.size(); ++i) changing += changes_before(i) ? 1 : 0;
  const int intervals =
      std::clamp(most_intervals / std::max(changing, 1), least_intervals_of_one, most_intervals_of_one);

  const double most_extinction = -std::log1p(-largest_opacity) / transfer.unit_length();
  const auto clamped = [most_extinction](double s, Optics optics) {
    optics.extinction = std::min(optics.extinction, most_extinction);
    return TransferPoint{s, optics};
  };
  std::vector<TransferPoint> linear;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 1; k < intervals && changes_before(i); ++k) {
      const double s = std::lerp(points[i - 1].s, points[i].s, static_cast<double>(k) / intervals);
      // Scalars that are neighbours in binary64 have no room for so many.
      if (s > linear.back().s && s < points[i].s) linear.push_back(clamped(s, transfer.at(s)));
    }
    linear.push_back(clamped(points[i].s, points[i].optics));
  }
  return PiecewiseLinear(std::move(linear));
}

}  // namespace raytruth
