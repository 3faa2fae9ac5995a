#include "raytruth/reference/knot_cut.hpp"

#include "raytruth/kernels/kernels.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace raytruth {

namespace {

/// The abscissae in (0, 1) between which the polynomial is monotone.
template <int Degree>
SignChanges<double, Degree> turning_points(const Bernstein<Degree>& polynomial) {
  const auto slope = polynomial.derivative();
  const auto& d = slope.coefficients;
  const auto [least, most] = std::minmax_element(d.begin(), d.end());
  SignChanges<double, Degree> result;
  if (*least >= 0 || *most <= 0) return result;
  if constexpr (Degree == 3) {
    // d_0 (1-u)^2 + 2 d_1 u (1-u) + d_2 u^2, with v = u / (1-u): d_2 v^2 + 2 d_1 v + d_0 = 0.
    const double discriminant = d[1] * d[1] - d[0] * d[2];
    if (!(discriminant > 0)) return result;
    const double q = -(d[1] + std::copysign(std::sqrt(discriminant), d[1]));
    std::array roots{q / (q + d[2]), d[0] / (d[0] + q)};  // v = q / d_2 and v = d_0 / q
    std::sort(roots.begin(), roots.end());
    for (const double u : roots)
      if (u > 0 && u < 1) result.push_back(u);
  } else {
    for (const double u : slope.sign_changes()) result.push_back(u);
  }
  return result;
}

}  // namespace

template <int Degree>
void KnotCut::operator()(const LinearIntervals& intervals, const Bernstein<Degree>& polynomial, std::size_t piece,
                         std::vector<KnotStretch>& stretches) {
  const auto& knots = intervals.knots();
  const auto& b = polynomial.coefficients;
  // The right-hand value counts: a constant at a knot belongs to the interval above.
  const auto at_or_below = [&](double s) {
    return static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), s) - knots.begin());
  };
  const auto below = [&](double s) {
    return static_cast<std::size_t>(std::lower_bound(knots.begin(), knots.end(), s) - knots.begin());
  };
  const auto [least, most] = std::minmax_element(b.begin(), b.end());
  const std::size_t lowest = at_or_below(*least);
  if (lowest == knots.size() || *most <= knots[lowest]) {
    stretches.push_back({piece, 0, 1, lowest});
    return;
  }

  double begin = 0;
  std::size_t interval = lowest;
  double part_begin = 0;
  double value = b.front();
  const auto part = [&](double part_end, double value_at_end) {
    const bool ascends = value < value_at_end;
    const std::size_t first = ascends ? at_or_below(value) : below(value);
    const std::size_t last = ascends ? below(value_at_end) : at_or_below(value_at_end);
    if (begin == part_begin) interval = first;
    targets_.clear();
    // Crossing knot k upwards leads into interval k + 1, downwards into interval k.
    if (ascends)
      for (std::size_t k = first; k < last; ++k) targets_.push_back(knots[k]);
    else
      for (std::size_t k = first; k-- > last;) targets_.push_back(knots[k]);
    if (!targets_.empty()) {
      abscissae_.resize(targets_.size());
      kernels<Degree>().crossings(b, part_begin, part_end, targets_.data(), targets_.size(), intervals.has_jumps(),
                                  abscissae_.data());
      std::size_t here = first;
      for (const double abscissa : abscissae_) {
        if (abscissa > begin) {
          stretches.push_back({piece, begin, abscissa, here});
          begin = abscissa;
        }
        here = ascends ? here + 1 : here - 1;
      }
      interval = here;
    }
    part_begin = part_end;
    value = value_at_end;
  };
  for (const double u : turning_points(polynomial)) part(u, polynomial.value(u));
  part(1, b.back());
  if (begin < 1) stretches.push_back({piece, begin, 1, interval});
}

template void KnotCut::operator()(const LinearIntervals&, const Bernstein<3>&, std::size_t, std::vector<KnotStretch>&);
template void KnotCut::operator()(const LinearIntervals&, const Bernstein<largest_degree>&, std::size_t,
                                  std::vector<KnotStretch>&);

}  // namespace raytruth
