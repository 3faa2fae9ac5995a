#include "raytruth/tables/interval_slabs.hpp"

#include "raytruth/reference/piece_integral.hpp"

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

/// Optics at s as they are from below: at a jump the left-hand value.
Optics before(const PiecewiseLinear& transfer, double s) {
  const auto& points = transfer.points();
  const auto at_or_after = std::lower_bound(points.begin(), points.end(), s,
                                            [](const TransferPoint& point, double x) { return point.s < x; });
  return at_or_after != points.end() && at_or_after->s == s ? at_or_after->optics : transfer.at(s);
}

}  // namespace

IntervalSlabs::IntervalSlabs(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission)
    : intervals_(axes.size - 1), emission_(emission) {
  check(axes);
  std::vector<double> knots;
  for (const TransferPoint& point : transfer.points())
    if (knots.empty() || knots.back() != point.s) knots.push_back(point.s);
  auto knot = knots.begin();
  for (std::size_t k = 0; k < intervals_; ++k) {
    const double low = axes.scalar(k);
    const double high = axes.scalar(k + 1);
    double begin = low;
    const auto add = [&](double end) {
      parts_.push_back({k, (end - begin) / (high - low), {transfer.at(begin), before(transfer, end)}});
      begin = end;
    };
    for (; knot != knots.end() && *knot < high; ++knot)
      if (*knot > low) add(*knot);
    add(high);
  }
}

std::vector<Vec4> IntervalSlabs::operator()(double length, bool backwards) const {
  std::vector<Vec4> slabs(intervals_, Vec4::Constant(0));
  const std::size_t count = parts_.size();
  const auto part = [&](std::size_t i) -> const LinearPart& { return parts_[backwards ? count - 1 - i : i]; };
  for (std::size_t first = 0; first < count; first += lane_count) {
    const std::size_t used = std::min(lane_count, count - first);
    LinearPiece<3, Eight> pieces;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const auto& [interval, share, ends] = part(first + std::min(lane, used - 1));
      for (std::size_t j = 0; j <= 3; ++j) pieces.x[j][lane] = static_cast<double>(j) / 3;
      pieces.extinction_at_0[lane] = ends[backwards ? 1 : 0].extinction;
      pieces.extinction_at_1[lane] = ends[backwards ? 0 : 1].extinction;
      pieces.length[lane] = share * length;
    }
    const PieceIntegral<Eight> integrals = integrate(pieces, emission_);
    for (std::size_t lane = 0; lane < used; ++lane) {
      const auto& [interval, share, ends] = part(first + lane);
      Vec4 slab;
      slab.head<3>() = integrals.weight_0[lane] * ends[backwards ? 1 : 0].color +
                       integrals.weight_1[lane] * ends[backwards ? 0 : 1].color;
      slab[3] = -std::expm1(-integrals.depth[lane]);
      Vec4& whole = slabs[backwards ? intervals_ - 1 - interval : interval];
      whole = Rules<double>{}.over(whole, slab);
    }
  }
  return slabs;
}

}  // namespace raytruth
