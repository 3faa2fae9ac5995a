#include "raytruth/shading/slab_optics.hpp"

#include "raytruth/kernels/gauss_legendre.hpp"

namespace raytruth {

namespace {

// Distances of finite scalars may overflow; those of their halves do not.

/// The optics between two neighbouring points, at `s` in [a.s, b.s].
Optics between(const TransferPoint& a, const TransferPoint& b, double s) {
  const double weight = (s / 2 - a.s / 2) / (b.s / 2 - a.s / 2);
  return {std::lerp(a.optics.extinction, b.optics.extinction, weight),
          a.optics.color + weight * (b.optics.color - a.optics.color)};
}

}  // namespace

SlabOptics::SlabOptics(const PiecewiseLinear& transfer, double front, double back, double length) : length_(length) {
  if (transfer.is_linear_in_opacity()) {
    *this = SlabOptics(linear_in_extinction(transfer), front, back, length);
    return;
  }
  const double low = std::min(front, back);
  const double high = std::max(front, back);
  const auto x_of = [&](double s) { return (s / 2 - front / 2) / (back / 2 - front / 2); };
  // Ascending in s, whose ends become begin and end.
  const auto add = [&](double begin, double end, const Optics& at_begin, const Optics& at_end) {
    const double slope = end > begin ? (at_end.extinction / 2 - at_begin.extinction / 2) / (end / 2 - begin / 2) : 0;
    stretches_.push_back({begin, end, at_begin, at_end, 0, slope});
  };
  const auto& points = transfer.points();
  if (low == high) {
    stretches_.push_back({0, 1, transfer.at(low), transfer.at(low), 0, 0});
  } else {
    const auto& first = points.front();
    const auto& last = points.back();
    if (low < first.s) add(low, std::min(high, first.s), first.optics, first.optics);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const double begin = std::max(low, points[i].s);
      const double end = std::min(high, points[i + 1].s);
      if (begin < end)
        add(begin, end, between(points[i], points[i + 1], begin), between(points[i], points[i + 1], end));
    }
    if (high > last.s) add(std::max(low, last.s), high, last.optics, last.optics);
    if (front > back) {
      std::reverse(stretches_.begin(), stretches_.end());
      for (Stretch& stretch : stretches_) {
        std::swap(stretch.begin, stretch.end);
        std::swap(stretch.front, stretch.back);
      }
    }
    for (Stretch& stretch : stretches_) {
      stretch.begin = x_of(stretch.begin);
      stretch.end = x_of(stretch.end);
    }
  }
  for (Stretch& stretch : stretches_) {
    stretch.depth = depth_;
    depth_ += length * (stretch.end - stretch.begin) * 0.5 * (stretch.front.extinction + stretch.back.extinction);
    largest_color_ = std::max({largest_color_, stretch.front.color.maxCoeff(), stretch.back.color.maxCoeff()});
  }
}

SlabRule slab_rule() {
  constexpr std::size_t nodes = 16;
  static const NodeTable<3>& table = node_table<3>(nodes);
  return {{table.nodes.data(), nodes}, {table.weights.data(), nodes}};
}

SlabMoments slab_moments(const SlabOptics& optics, Emission emission) {
  return slab_integral<5>(optics, emission, {0.5}, [](double s, double /*slope*/) {
    return std::array<double, 5>{1, s, s * s, s * s * s, s < 0.5 ? 2 * s : 2 - 2 * s};
  });
}

std::array<double, 4> homogeneous_moments(double depth) {
  constexpr double largest_in_series = 2;
  constexpr int terms = 30;  // 2^30 / 30! < 1e-23
  std::array<double, 4> moments{};
  if (depth < largest_in_series) {
    double power = 1;  // (-depth)^m / m!
    for (int m = 0; m < terms; ++m) {
      for (std::size_t k = 0; k < moments.size(); ++k) moments[k] += power / (static_cast<double>(k) + m + 1);
      power *= -depth / (m + 1);
    }
    return moments;
  }
  const double behind = std::exp(-depth);
  moments[0] = -std::expm1(-depth) / depth;
  for (std::size_t k = 1; k < moments.size(); ++k)
    moments[k] = (static_cast<double>(k) * moments[k - 1] - behind) / depth;
  return moments;
}

}  // namespace raytruth
