#include "raytruth/schemes/quadratic_gray.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace raytruth {

namespace {

constexpr unsigned node_count = 16;
constexpr double deepest_part = 2;
constexpr double most_parts = 1e6;  ///< a stretch that needs more is opaque within few of them
constexpr double dark = 1e-20;      ///< a transmittance behind which no light is seen

/// The nodes of the rule on [0, 1], and their weights.
struct Rule {
  std::array<double, node_count> nodes{};
  std::array<double, node_count> weights{};

  Rule() {
    using Gauss = boost::math::quadrature::gauss<double, node_count>;
    for (std::size_t i = 0; i < node_count / 2; ++i) {
      const double half = 0.5 * Gauss::abscissa()[i];
      nodes[2 * i] = 0.5 - half;
      nodes[2 * i + 1] = 0.5 + half;
      weights[2 * i] = weights[2 * i + 1] = 0.5 * Gauss::weights()[i];
    }
  }
};

}  // namespace

QuadraticGray QuadraticGray::of_curvature(double front, double back, double curvature, double length) {
  QuadraticGray slab{.front = front, .back = back};
  if (curvature != 0) {
    slab.orientation = curvature > 0 ? 1 : -1;
    slab.radius = 1 / std::sqrt(std::abs(curvature));
  }
  slab.scaled_length = length / slab.radius;
  slab.slope = Rules<double>{}.quadratic_gray_slope(front, back, slab.orientation, slab.scaled_length);
  return slab;
}

namespace {

/// Adds the cuts on a monotone branch, from z to `end`.
void cut_branch(const QuadraticGray& slab, double z, double end, const std::vector<double>& scalars,
                std::vector<QuadraticGrayCut>& cuts) {
  Rules<double> rules;
  const double low = z == 0 ? slab.front : slab.extremum();
  const double high = end == slab.scaled_length ? slab.back : slab.extremum();
  const bool rises = high > low;
  const auto begin = scalars.begin();
  // Points that the branch begins or ends on are not passed; it lies on their side of its other scalars.
  auto next = rises ? std::upper_bound(begin, scalars.end(), low) : std::lower_bound(begin, scalars.end(), low);
  cuts.push_back({z, static_cast<std::size_t>(next - begin)});
  const auto pass = [&](double point, std::size_t interval) {
    const double place =
        rules.quadratic_gray_place(point - slab.front, slab.slope, slab.orientation, rises ? 1.0 : -1.0);
    z = std::clamp(place, z, end);
    cuts.push_back({z, interval});
  };
  if (rises)
    for (; next != scalars.end() && *next < high; ++next) pass(*next, static_cast<std::size_t>(next - begin) + 1);
  else
    for (; next != begin && *(next - 1) > high; --next) pass(*(next - 1), static_cast<std::size_t>(next - begin) - 1);
}

}  // namespace

void cut(const QuadraticGray& slab, const std::vector<double>& scalars, std::vector<QuadraticGrayCut>& cuts) {
  cuts.clear();
  const double end = slab.scaled_length;
  if (slab.turns()) {
    const double turn = std::clamp(-0.5 * slab.orientation * slab.slope, 0.0, end);
    cut_branch(slab, 0, turn, scalars, cuts);
    cut_branch(slab, turn, end, scalars, cuts);
  } else if (slab.front != slab.back) {
    cut_branch(slab, 0, end, scalars, cuts);
  } else {
    const auto after = std::upper_bound(scalars.begin(), scalars.end(), slab.front);
    cuts.push_back({0, static_cast<std::size_t>(after - scalars.begin())});
  }
  cuts.push_back({end, 0});
}

TransferIntervals::TransferIntervals(const PiecewiseLinear& transfer) {
  if (transfer.is_linear_in_opacity())
    throw InputError(
        "the quadratic gray-value model with a transfer function that is linear in opacity; one that is linear in "
        "extinction is allowed, or the scheme order2, whose slabs are the same");
  const auto& points = transfer.points();
  for (const TransferPoint& point : points)
    if (scalars.empty() || scalars.back() != point.s) scalars.push_back(point.s);
  for (std::size_t i = 0; i <= scalars.size(); ++i) {
    const bool is_between = i > 0 && i < scalars.size();
    const double from = scalars[i > 0 ? i - 1 : 0];
    const Optics low = i > 0 ? transfer.at(from) : transfer.before(from);
    Interval interval{.from = from, .extinction = low.extinction};
    for (std::size_t c = 0; c < 3; ++c) interval.color[c] = low.color[static_cast<Eigen::Index>(c)];
    if (is_between) {
      const Optics high = transfer.before(scalars[i]);
      const double width = scalars[i] - from;
      interval.extinction_slope = (high.extinction - low.extinction) / width;
      for (std::size_t c = 0; c < 3; ++c)
        interval.color_slope[c] = (high.color[static_cast<Eigen::Index>(c)] - interval.color[c]) / width;
    }
    intervals.push_back(interval);
  }
}

QuadraticGraySlabs::QuadraticGraySlabs(const PiecewiseLinear& transfer, Emission emission)
    : transfer_(transfer), emission_(emission) {}

namespace {

using Interval = TransferIntervals::Interval;

double extinction_at(const QuadraticGray& slab, const Interval& interval, double z) {
  return interval.extinction + interval.extinction_slope * (slab.value(z) - interval.from);
}

/// The integral of tau(h(z)) on an interval: Simpson's rule, exact for a parabola.
double depth(const QuadraticGray& slab, const Interval& interval, double from, double to) {
  return (to - from) / 6 *
         (extinction_at(slab, interval, from) + 4 * extinction_at(slab, interval, 0.5 * (from + to)) +
          extinction_at(slab, interval, to));
}

}  // namespace

double QuadraticGraySlabs::omega(const QuadraticGray& slab) {
  cut(slab, transfer_.scalars, cuts_);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < cuts_.size(); ++i)
    sum += depth(slab, transfer_.intervals[cuts_[i].interval], cuts_[i].z, cuts_[i + 1].z);
  return std::max(sum, 0.0);
}

template <class WeightAt>
QuadraticGraySlabs::vec4 QuadraticGraySlabs::integrate(const QuadraticGray& slab, const WeightAt& weight_at,
                                                       double kink) {
  static const Rule rule;
  cut(slab, transfer_.scalars, cuts_);
  if (kink > 0 && kink < slab.scaled_length) {
    const auto behind =
        std::find_if(cuts_.begin(), cuts_.end(), [kink](const QuadraticGrayCut& c) { return c.z >= kink; });
    cuts_.insert(behind, {kink, (behind - 1)->interval});
  }
  vec4 result = vec4::Zero();
  double in_front = 0;  // the optical depth so far
  for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
    const Interval& interval = transfer_.intervals[cuts_[i].interval];
    const double from = cuts_[i].z;
    const double width = cuts_[i + 1].z - from;
    const double whole = slab.radius * depth(slab, interval, from, from + width);
    const double steepest =
        std::max(std::abs(extinction_at(slab, interval, from)), std::abs(extinction_at(slab, interval, from + width)));
    const double parts = std::ceil(std::clamp(slab.radius * steepest * width / deepest_part, 1.0, most_parts));
    double before = 0;
    for (std::int64_t part = 0; part < static_cast<std::int64_t>(parts) && std::exp(-in_front - before) > dark;
         ++part) {
      const double start = from + width * (static_cast<double>(part) / parts);
      const double length = width / parts;
      for (std::size_t k = 0; k < node_count; ++k) {
        const double z = start + length * rule.nodes[k];
        const double above = slab.value(z) - interval.from;
        const double seen = std::exp(-(in_front + before + slab.radius * depth(slab, interval, start, z)));
        const double weight = slab.radius * length * rule.weights[k] * seen * weight_at(interval, z);
        for (std::size_t c = 0; c < 3; ++c)
          result[static_cast<Eigen::Index>(c)] += weight * (interval.color[c] + interval.color_slope[c] * above);
      }
      before += slab.radius * depth(slab, interval, start, start + length);
    }
    in_front += whole;
  }
  result[3] = -std::expm1(-std::max(in_front, 0.0));
  return result;
}

QuadraticGraySlabs::vec4 QuadraticGraySlabs::operator()(const QuadraticGray& slab) {
  if (emission_ == Emission::plain)
    return integrate(slab, [](const Interval& /*interval*/, double /*z*/) { return 1.0; });
  return integrate(slab, [&slab](const Interval& interval, double z) { return extinction_at(slab, interval, z); });
}

QuadraticGraySlabs::vec4 QuadraticGraySlabs::operator()(const QuadraticGray& slab, const GradientLight& light) {
  cut(slab, transfer_.scalars, cuts_);
  for (std::size_t i = 0; i + 2 < cuts_.size(); ++i) {
    const std::size_t lower = std::min(cuts_[i].interval, cuts_[i + 1].interval);
    if (cuts_[i].interval == cuts_[i + 1].interval) continue;
    const Interval& below = transfer_.intervals[lower];
    const Interval& above = transfer_.intervals[lower + 1];
    const double from_below = below.extinction + below.extinction_slope * (above.from - below.from);
    if (std::abs(from_below - above.extinction) > 1e-12 * std::max(from_below, above.extinction))
      throw InputError(fmt::format(
          "found a jump of the extinction at scalar {} with light by its gradient; continuous extinctions are allowed",
          above.from));
  }
  const double difference = (light.back - light.front) / slab.scaled_length;
  const auto weight_at = [&](const Interval& interval, double z) {
    const double slope = interval.extinction_slope;
    double weight = light.front + difference * z;
    if (light.is_corrected) {
      // Where the extinction falls the normal is turned round.
      const double sign = slope > 0 ? 1 : slope < 0 ? -1 : 0;
      weight = std::max(sign * weight, 0.0);
      return sign == 0 ? 0.0 : std::pow(weight, light.weight_power);
    }
    const double strength = std::pow(slope, light.slope_power);
    if (std::isnan(strength))
      throw InputError(fmt::format(
          "found a falling extinction and the exponent {}, a power of a negative number; whole exponents are allowed",
          light.slope_power));
    return strength * std::pow(weight, light.weight_power);
  };
  return integrate(slab, weight_at, light.is_corrected ? -light.front / difference : 0.0);
}

}  // namespace raytruth
