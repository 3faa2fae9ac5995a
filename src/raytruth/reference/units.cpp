#include "raytruth/reference/units.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr int most_of_extinction = 500;  // 2^500: what LinearIntervals takes
constexpr int faint = -200;

/// x < 2^exponent, the least one; 0 of 0.
int exponent_of(double x) {
  int exponent = 0;
  static_cast<void>(std::frexp(x, &exponent));
  return exponent;
}

bool is_faint(const std::vector<double>& opacities) {
  return std::all_of(opacities.begin(), opacities.end(), [](double opacity) { return opacity < 0x1p-100; });
}

}  // namespace

Units units_for(const PiecewiseLinear& transfer, double length) {
  double most_extinction = 0;
  double most_color = 0;
  for (const TransferPoint& point : transfer.points()) {
    most_extinction = std::max(most_extinction, point.optics.extinction);
    most_color = std::max(most_color, point.optics.color.maxCoeff());
  }
  const auto& opacities = transfer.opacities();
  const bool is_opaque = std::find(opacities.begin(), opacities.end(), 1) != opacities.end();
  Units units{.length = exponent_of(length), .extinction = 0, .color = exponent_of(most_color)};
  const int extinction = exponent_of(most_extinction);
  if (extinction + units.length > most_of_extinction) units.length = std::max(0, most_of_extinction - extinction);
  units.extinction = -units.length;
  if (most_extinction > 0 && !is_opaque) units.extinction += std::min(0, extinction + exponent_of(length) - faint);
  return units;
}

PiecewiseLinear in_units(const PiecewiseLinear& transfer, const Units& units) {
  std::vector<TransferPoint> points = transfer.points();
  const auto& opacities = transfer.opacities();
  if (!opacities.empty() && (units.depth() == 0 || !is_faint(opacities))) {
    std::vector<OpacityPoint> same;
    for (std::size_t i = 0; i < points.size(); ++i)
      same.push_back({points[i].s, opacities[i],
                      points[i].optics.color.unaryExpr([&](double c) { return std::ldexp(c, -units.color); })});
    return from_opacity(same, std::ldexp(transfer.unit_length(), units.extinction));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Optics& optics = points[i].optics;
    optics.color = optics.color.unaryExpr([&](double c) { return std::ldexp(c, -units.color); });
    if (opacities.empty()) {
      optics.extinction = std::ldexp(optics.extinction, -units.extinction);
      continue;
    }
    int of_opacity = 0;
    int of_length = 0;
    const double opacity = std::frexp(opacities[i], &of_opacity);
    const double unit_length = std::frexp(transfer.unit_length(), &of_length);
    optics.extinction = std::ldexp(opacity / unit_length, of_opacity - of_length - units.extinction);
  }
  return PiecewiseLinear(std::move(points));
}

template <int Degree>
Chain<Degree> in_units(Chain<Degree> signal, const Units& units) {
  const auto in_unit = [&](const DoubleDouble& t) -> DoubleDouble {
    return {std::ldexp(t.high, -units.length), std::ldexp(t.low, -units.length)};
  };
  for (auto& piece : signal.pieces) {
    piece.start = in_unit(piece.start);
    piece.length = std::ldexp(piece.length, -units.length);
  }
  signal.end = in_unit(signal.end);
  return signal;
}

SignalError in_units(SignalError error, const Units& units) {
  error.of_length = std::ldexp(error.of_length, -units.length);
  error.unclaimed = std::ldexp(error.unclaimed, -units.length);
  return error;
}

template Chain<3> in_units(Chain<3>, const Units&);
template Chain<largest_degree> in_units(Chain<largest_degree>, const Units&);

}  // namespace raytruth
