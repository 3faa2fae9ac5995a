#pragma once

#include "raytruth/kernels/exponential.hpp"
#include "raytruth/kernels/kernels.hpp"
#include "raytruth/kernels/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace raytruth::inline RAYTRUTH_LEVEL {

/// De Casteljau's steps at u from points 0 ... from to points 0 ... to. Convex combinations: each step errs by at most
/// 3 units of the largest magnitude.
template <std::size_t Count>
void reduce(std::array<Lanes, Count>& points, std::size_t from, std::size_t to, const Lanes& u) {
  const Lanes v = 1 - u;
  for (std::size_t last = from; last > to; --last)
    for (std::size_t i = 0; i < last; ++i) points[i] = multiply_add(v, points[i], u * points[i + 1]);
}

/// An unevaluated sum: high, and what its rounding left.
struct LanePair {
  Lanes high;
  Lanes low;
};

/// a + b exactly (Knuth).
inline LanePair two_sum(const Lanes& a, const Lanes& b) {
  const Lanes sum = a + b;
  const Lanes b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a * b exactly (Dekker): not every level has fused products.
inline LanePair two_product(const Lanes& a, const Lanes& b) {
  constexpr double splitter = 0x1p27 + 1;
  const auto split = [](const Lanes& x) {
    const Lanes scaled = splitter * x;
    const Lanes high = scaled - (scaled - x);
    return LanePair{high, x - high};
  };
  const Lanes product = a * b;
  const LanePair x = split(a);
  const LanePair y = split(b);
  return {product, ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

/// s(u) - origin by de Casteljau's algorithm in pairs: beside the rounding of the result it errs by less than
/// 2^-90 times the largest |s_j - origin| (each of at most 9 steps by 16 units of 2^-106, doubled by each later one).
template <int Degree>
LanePair precise_value(const std::array<LanePair, Degree + 1>& coefficients, const Lanes& u) {
  auto points = coefficients;
  for (std::size_t last = Degree; last > 0; --last)
    for (std::size_t i = 0; i < last; ++i) {
      LanePair difference = two_sum(points[i + 1].high, -points[i].high);
      difference.low += points[i + 1].low - points[i].low;
      LanePair product = two_product(u, difference.high);
      product.low += u * difference.low;
      const LanePair sum = two_sum(points[i].high, product.high);
      points[i] = {sum.high, sum.low + (points[i].low + product.low)};
    }
  return points[0];
}

/// x on [begin, end]: the value at begin, from where the differences of neighbouring coefficients, which are those of
/// the derivative's polar forms times end - begin, add up. So the error shrinks with the stretch, as it must where a
/// table of 256 points magnifies it. With d the largest difference |s_(j+1) - s_j|, in units of d (end - begin): each
/// polar form errs by 3 (Degree - 1) + 1, its product with the width by 2, and Degree of them with their partial sums
/// by less than 4 Degree^2; the value at begin, and its part in the sums, by Degree + 1 units of its own. A whole piece
/// keeps its coefficients, with one rounding each. Scaling, and the offset, err by 5 units of x.
template <int Degree>
[[gnu::flatten]] NormalisedStretches<Degree> normalise(const Stretches<Degree>& stretches) {
  const Lanes begin(stretches.begin);
  const Lanes end(stretches.end);
  const Lanes width = end - begin;
  const Lanes scale(stretches.scale);
  const Lanes offset(stretches.offset);
  std::array<LanePair, Degree + 1> signal;
  std::array<Lanes, Degree> differences;
  Lanes reach{};
  Lanes largest_difference{};
  for (std::size_t j = 0; j <= Degree; ++j) {
    signal[j] = two_sum(Lanes(stretches.signal[j]), -Lanes(stretches.origin));
    reach = larger(reach, magnitude(signal[j].high));
    if (j == 0) continue;
    differences[j - 1] = Lanes(stretches.signal[j]) - Lanes(stretches.signal[j - 1]);
    largest_difference = larger(largest_difference, magnitude(differences[j - 1]));
  }
  std::array<Lanes, Degree> steps;
  for (std::size_t j = Degree; j-- > 0;) {
    auto points = differences;
    reduce(points, j, 0, end);
    steps[j] = width * points[0];
    if (j > 0) reduce(differences, j, j - 1, begin);
  }
  const LaneBits is_part = width < Lanes(1);
  std::array<Lanes, Degree + 1> x;
  const auto value_at = [&](const Lanes& u, const LanePair& whole) {
    const LanePair value = precise_value<Degree>(signal, u);
    return LanePair{select(is_part, value.high, whole.high), select(is_part, value.low, whole.low)};
  };
  const LanePair at_begin = value_at(begin, signal[0]);
  const LanePair at_end = value_at(end, signal[Degree]);
  x[0] = at_begin.high + at_begin.low;
  const Lanes part_error =
      unit_roundoff * ((Degree + 1) * magnitude(x[0]) + 4 * Degree * Degree * width * largest_difference) +
      0x1p-90 * reach;
  for (std::size_t j = 1; j <= Degree; ++j) x[j] = select(is_part, x[j - 1] + steps[j - 1], signal[j].high);
  Lanes largest_x{};
  for (std::size_t j = 0; j <= Degree; ++j) {
    x[j] = offset + scale * x[j];
    largest_x = larger(largest_x, magnitude(x[j]));
  }
  const Lanes error =
      (1 + 0x1p-20) * (scale * (select(is_part, part_error, unit_roundoff * reach) + Lanes(stretches.signal_error)) +
                       5 * unit_roundoff * (largest_x + offset));

  // The two ends are known to their own rounding, and so are all coefficients of a whole piece: what touches a point of
  // the transfer function, or nearly so, is on one side of it for certain.
  const auto margin = [&](const LanePair& value, const Lanes& knot, double sign) {
    const LanePair shift = two_sum(Lanes(stretches.origin), -knot);
    const LanePair total = two_sum(value.high, shift.high);
    const Lanes distance = sign * (total.high + (total.low + (value.low + shift.low)));
    const Lanes distance_error =
        (1 + 0x1p-20) * (8 * unit_roundoff * magnitude(distance) + Lanes(stretches.signal_error) +
                         select(is_part, 0x1p-90 * reach, Lanes(0)));
    return scale * (distance - distance_error);
  };
  const auto margins = [&](const Lanes& knot, double sign, const Lanes& x_at_knot) {
    Lanes inside = 0x1p1000;
    for (std::size_t j = 1; j < Degree; ++j) {
      const Lanes by_x = sign * (x[j] - x_at_knot) - error;
      inside = smaller(inside, select(is_part, by_x, margin(signal[j], knot, sign)));
    }
    return Margins{Eight(margin(at_begin, knot, sign)), Eight(margin(at_end, knot, sign)), Eight(inside)};
  };
  NormalisedStretches<Degree> result;
  result.from_0 = margins(Lanes(stretches.bottom), 1, 0);
  result.from_1 = margins(Lanes(stretches.top), -1, 1);
  for (std::size_t j = 0; j <= Degree; ++j) result.x[j] = Eight(x[j]);
  result.x_error = Eight(error);
  return result;
}

/// Newton's method, kept inside its bracket by bisection, for eight targets at a time, in powers of u. Two digits short
/// of the end it stops, since one more step doubles the digits: by rounded values, which leaves a misplacement of some
/// roundings; or, where the transfer function jumps, by precise ones, which leaves that of the abscissa itself.
template <int Degree>
[[gnu::flatten]] void crossings(const std::array<double, Degree + 1>& coefficients, double begin, double end,
                                const double* targets, std::size_t count, bool precisely, double* abscissae) {
  std::array<double, Degree + 1> powers = coefficients;
  for (std::size_t k = 1; k <= Degree; ++k)
    for (std::size_t i = Degree; i >= k; --i)
      powers[i] = (powers[i] - powers[i - 1]) * (static_cast<double>(Degree - k + 1) / static_cast<double>(k));
  const auto value_and_slope = [&powers](const auto& u) {
    using Vector = std::remove_cvref_t<decltype(u)>;
    Vector value = powers[Degree];
    Vector slope = 0;
    for (std::size_t k = Degree; k-- > 0;) {
      slope = multiply_add(slope, u, value);
      value = multiply_add(value, u, Vector(powers[k]));
    }
    return std::array{value, slope};
  };
  const auto [value_at_begin, slope_at_begin] = value_and_slope(begin);
  const auto [value_at_end, slope_at_end] = value_and_slope(end);
  const double sign = value_at_begin < value_at_end ? 1 : -1;
  // Guesses by Hermite's cubic for the inverse function, its slopes limited so that it stays monotone.
  const double rise = value_at_end - value_at_begin;
  const double per_value = rise == 0 ? 0 : 1 / rise;
  const double secant = rise / (end - begin);
  const auto inverse_slope = [secant](double slope) {
    return std::abs(slope) > std::abs(secant) / 3 ? secant / slope : 3;
  };
  const double at_begin = inverse_slope(slope_at_begin);
  const double at_end = inverse_slope(slope_at_end);
  const double nearly_converged = 0x1p-18 * (end - begin);
  // Where the slope vanishes at the target itself Newton's step is 0, not 0 / 0.
  const double tiny = sign * 0x1p-1000;
  constexpr int most_steps = 64;

  for (std::size_t first = 0; first < count; first += lane_count) {
    const std::size_t used = std::min(lane_count, count - first);
    Eight wanted;
    wanted.fill(targets[first]);
    std::copy_n(targets + first, used, wanted.begin());
    const Lanes target(wanted);
    Lanes low = begin;
    Lanes high = end;
    const Lanes share = (target - value_at_begin) * per_value;
    const Lanes rest = 1 - share;
    const Lanes guess = share * (at_begin * rest * rest + share * (rest * (3 - at_end) + share));
    auto u = smaller<Lanes>(larger<Lanes>(begin + (end - begin) * guess, begin), end);
    for (int step = 0; step < most_steps; ++step) {
      const auto [value, slope] = value_and_slope(u);
      const Lanes newton = u - (value - target) / (slope + tiny);
      const LaneBits is_beyond = Lanes(0.0) < sign * (value - target);
      low = select(is_beyond, low, u);
      high = select(is_beyond, u, high);
      const Lanes middle = 0.5 * (low + high);
      const Lanes next = select(newton < low, middle, select(high < newton, middle, newton));
      const LaneBits moves = Lanes(nearly_converged) < magnitude(next - u);
      u = next;
      if (!any(moves)) break;
    }
    const auto [value, slope] = value_and_slope(u);
    Lanes residual = value - target;
    if (precisely) {
      std::array<LanePair, Degree + 1> residuals;
      for (std::size_t j = 0; j <= Degree; ++j) residuals[j] = two_sum(Lanes(coefficients[j]), -target);
      const LanePair precise = precise_value<Degree>(residuals, u);
      residual = precise.high + precise.low;
    }
    const Lanes last = residual / (slope + tiny);
    u = select(magnitude(last) < Lanes(4 * nearly_converged), u - last, u);
    const Eight result(smaller<Lanes>(larger<Lanes>(u, begin), end));
    std::copy_n(result.begin(), used, abscissae + first);
  }
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
