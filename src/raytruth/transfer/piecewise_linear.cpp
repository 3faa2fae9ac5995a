#include "raytruth/transfer/piecewise_linear.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

constexpr int intervals_per_opacity_interval = 1024;

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

Optics interpolate(const TransferPoint& a, const TransferPoint& b, double s) {
  // Scalars are halved first: the distance of two finite ones may overflow.
  const double weight = (s / 2 - a.s / 2) / (b.s / 2 - a.s / 2);
  return {std::lerp(a.optics.extinction, b.optics.extinction, weight),
          a.optics.color + weight * (b.optics.color - a.optics.color)};
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

Optics PiecewiseLinear::at(double s) const {
  const auto after = std::upper_bound(points_.begin(), points_.end(), s,
                                      [](double x, const TransferPoint& point) { return x < point.s; });
  if (after == points_.begin()) return points_.front().optics;
  if (after == points_.end() || (after - 1)->s == s) return (after - 1)->optics;
  return interpolate(*(after - 1), *after, s);
}

PiecewiseLinear from_opacity(const std::vector<OpacityPoint>& points, double unit_length) {
  check_points(points, [](const OpacityPoint& point) { return point.color; });
  if (!(unit_length > 0) || !std::isfinite(unit_length))
    throw InputError(fmt::format("found unit_length {}; a finite number > 0 is allowed", unit_length));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!(points[i].opacity >= 0 && points[i].opacity <= 1))
      throw PointError(i, fmt::format("found opacity {}; a number from 0 to 1 is allowed", points[i].opacity));

  const auto convert = [unit_length](double s, double opacity, const Vector3<double>& color) {
    return TransferPoint{s, {-std::log1p(-std::min(opacity, largest_opacity)) / unit_length, color}};
  };
  std::vector<TransferPoint> converted;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const OpacityPoint& point = points[i];
    if (i > 0 && points[i - 1].s < point.s) {
      const OpacityPoint& before = points[i - 1];
      for (int k = 1; k < intervals_per_opacity_interval; ++k) {
        const double weight = static_cast<double>(k) / intervals_per_opacity_interval;
        const double s = std::lerp(before.s, point.s, weight);
        // Scalars that are neighbours in binary64 have no room for so many.
        if (s <= converted.back().s || s >= point.s) continue;
        converted.push_back(convert(s, std::lerp(before.opacity, point.opacity, weight),
                                    before.color + weight * (point.color - before.color)));
      }
    }
    converted.push_back(convert(point.s, point.opacity, point.color));
  }
  return PiecewiseLinear(std::move(converted));
}

}  // namespace raytruth
