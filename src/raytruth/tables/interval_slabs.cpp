#include "raytruth/tables/interval_slabs.hpp"

#include "raytruth/reference/piece_integral.hpp"

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

}  // namespace

IntervalSlabs::IntervalSlabs(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission)
    : intervals_(axes.size - 1),
      emission_(emission),
      units_per_length_(transfer.is_linear_in_opacity() ? 1 / transfer.unit_length() : 0) {
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
      parts_.push_back({k, (end - begin) / (high - low), {transfer.at(begin), transfer.before(end)}, {}});
      if (units_per_length_ > 0) parts_.back().opacities = {transfer.opacity_at(begin), transfer.opacity_before(end)};
      begin = end;
    };
    for (; knot != knots.end() && *knot < high; ++knot)
      if (*knot > low) add(*knot);
    add(high);
  }
}

struct IntervalSlabs::EightIntegrals {
  PieceIntegral<Eight> integrals;
};

IntervalSlabs::EightIntegrals IntervalSlabs::integrals_from(std::size_t first, double length, bool backwards) const {
  const std::size_t begin = backwards ? 1 : 0;
  const std::size_t end = 1 - begin;
  LinearPiece<3, Eight> linear;
  OpacityPiece<3, Eight> opacity;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const LinearPart& here = part(std::min(first + lane, parts_.size() - 1), backwards);
    for (std::size_t j = 0; j <= 3; ++j) linear.x[j][lane] = static_cast<double>(j) / 3;
    linear.extinction_at_0[lane] = here.ends[begin].extinction;
    linear.extinction_at_1[lane] = here.ends[end].extinction;
    linear.length[lane] = here.share * length;
    opacity.units[lane] = linear.length[lane] * units_per_length_;
    for (std::size_t j = 0; j <= 3; ++j) {
      const double x = linear.x[j][lane];
      opacity.opacity[j][lane] = std::lerp(here.opacities[begin], here.opacities[end], x);
      opacity.clear[j][lane] = std::lerp(1 - here.opacities[begin], 1 - here.opacities[end], x);
    }
  }
  if (units_per_length_ == 0) return {integrate(linear, emission_)};
  opacity.x = linear.x;
  opacity.length = linear.length;
  return {integrate(opacity, emission_)};
}

std::vector<Vec4> IntervalSlabs::operator()(double length, bool backwards) const {
  std::vector<Vec4> slabs(intervals_, Vec4::Constant(0));
  for (std::size_t first = 0; first < parts_.size(); first += lane_count) {
    const auto [integrals] = integrals_from(first, length, backwards);
    for (std::size_t lane = 0; lane < std::min(lane_count, parts_.size() - first); ++lane) {
      const LinearPart& here = part(first + lane, backwards);
      Vec4 slab;
      slab.head<3>() = integrals.weight_0[lane] * here.ends[backwards ? 1 : 0].color +
                       integrals.weight_1[lane] * here.ends[backwards ? 0 : 1].color;
      slab[3] = -std::expm1(-integrals.depth[lane]);
      Vec4& whole = slabs[backwards ? intervals_ - 1 - here.interval : here.interval];
      whole = Rules<double>{}.over(whole, slab);
    }
  }
  return slabs;
}

}  // namespace raytruth
