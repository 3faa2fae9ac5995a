#pragma once

#include "raytruth/kernels/depth_table.hpp"
#include "raytruth/kernels/exponential.hpp"
#include "raytruth/kernels/lanes.hpp"
#include "raytruth/kernels/opacity_piece.hpp"
#include "raytruth/kernels/piece_kernel.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

// Pieces on which the opacity is linear in x: the extinction is f units, f = -ln(1 - a(u)), and the optical depth
// D(u) = scale integral_0^u f has no polynomial form. f is sampled at n Chebyshev points and its interpolating
// polynomial is integrated, by one matrix, up to the m nodes of Gauss's rule that integrates what the piece sends out,
// and up to 1. What is integrated there, and how, is as for linear pieces (piece_kernel.hpp).
//
// How the radius comes about. Let b = 1 - a, beta its Chebyshev coefficients on [-1, 1], and delta = sum_k>0 |beta_k|
// a_k / beta_0 with a_k = (rho^k + rho^-k) / 2 the largest |T_k| on the ellipse with foci -1, 1 and semiaxes' sum rho.
// For delta < 1, f is holomorphic there and |f - f_c| <= M = -ln(1 - delta), f_c = -ln(beta_0). Interpolation of degree
// n - 1 at Chebyshev's points errs by at most 4 M rho^(1-n) / (rho - 1) (L. N. Trefethen, Approximation Theory and
// Approximation Practice, theorem 8.2, whose proof by aliasing holds for the points of the first kind as well), and so
// does its integral over [0, u]. On the ellipse |D| <= scale / 2 (1 + a_1) (f_c + M), and -Re D <= scale / 2 (f_c (a_1
// - 1) + M (1 + a_1)), for Re(z + 1) >= 1 - a_1 and |z + 1| <= 1 + a_1: which bounds what Gauss's rule leaves out, with
// |x'| or |x| on it. Every rho is good; a few are tried, and the fewest points taken.
//
// Rounding: b is a sum of positive terms, with a relative error of a few units, and so is a but for what its
// coefficients fall below 0; f comes with a few units of itself from the one of them that has the digits.

namespace raytruth::inline RAYTRUTH_LEVEL {

constexpr double largest_delta = 0.95;
constexpr double most_per_delta = 3.16;  ///< -ln(1 - delta) / delta is at most this up to largest_delta
constexpr double log2_interpolation_goal = -52;
constexpr std::array<double, 5> ellipse_sums{1.6, 2.4, 3.8, 7, 16};

/// Numbers of an ellipse, for pieces on which the opacity is linear.
template <int Degree>
struct OpacityEllipse {
  explicit OpacityEllipse(double rho)
      : log2_interpolation(std::log2(rounding_slack * 4 * most_per_delta / (rho - 1))),
        log2_gauss(std::log2(rounding_slack * 32 / 15 / (1 - 1 / (rho * rho)))),
        samples_per_bit(rounding_slack / std::log2(rho)),
        nodes_per_bit(rounding_slack / (2 * std::log2(rho))) {
    for (int k = 0; k <= Degree; ++k) {
      const double a = rounding_slack * (std::pow(rho, k) + std::pow(rho, -k)) / 2;
      largest_chebyshev[static_cast<std::size_t>(k)] = a;
      chebyshev_sum += a;
    }
  }

  std::array<double, Degree + 1> largest_chebyshev{};  ///< a_k
  double chebyshev_sum = 0;                            ///< of all a_k
  double log2_interpolation;                           ///< of 4 M / delta / (rho - 1)
  double log2_gauss;                                   ///< of half of 64/15 / (1 - rho^-2)
  double samples_per_bit;                              ///< 1 / log2(rho)
  double nodes_per_bit;                                ///< 1 / (2 log2(rho))
};

template <int Degree>
const std::vector<OpacityEllipse<Degree>>& opacity_ellipses() {
  static const std::vector<OpacityEllipse<Degree>> list(ellipse_sums.begin(), ellipse_sums.end());
  return list;
}

/// What follows from the coefficients of a piece before any sampling.
template <int Degree, class Vector>
struct PreparedOpacity {
  std::array<Vector, Degree> rate{};         ///< Bernstein coefficients of x'
  Vector reach{};                            ///< of |x| and |1 - x|
  Vector steepest{};                         ///< of |x'|
  Vector scale{};                            ///< units: f times this is the depth
  Vector below{};                            ///< how far coefficients of a are below 0
  Vector from_x{};                           ///< error of f by that of x
  Vector centre{};                           ///< f_c, or what keeps it from 0
  Vector depth{};                            ///< of the piece, roughly
  decltype(Vector{} < Vector{}) is_plain{};  ///< else a may be 1, or the piece is too deep, and has to be halved
};

template <int Degree, class Vector>
PreparedOpacity<Degree, Vector> prepare(const OpacityPiece<Degree, Vector>& piece, const Vector& centre_opacity,
                                        const Vector& centre_clear) {
  PreparedOpacity<Degree, Vector> result;
  const Vector zero{};
  Vector lowest = piece.x[0];
  Vector highest = piece.x[0];
  Vector least_clear = piece.clear[0];
  Vector least_opacity = piece.opacity[0];
  for (std::size_t j = 1; j <= Degree; ++j) {
    const Vector x = piece.x[j];
    lowest = smaller(lowest, x);
    highest = larger(highest, x);
    least_clear = smaller(least_clear, piece.clear[j]);
    least_opacity = smaller(least_opacity, piece.opacity[j]);
    const Vector rate = Degree * (x - piece.x[j - 1]);
    result.steepest = larger(result.steepest, magnitude(rate));
    result.rate[j - 1] = rate;
  }
  result.reach = larger(highest, Vector(1.0 - lowest));
  result.scale = piece.units;
  result.below = larger(zero, Vector(zero - least_opacity));
  const Vector least = least_clear - piece.clear_error;
  // ln(1 - r) is at least -4/3 r for r up to 1/4.
  const auto is_known = 4 * piece.clear_error < least;
  result.from_x = select(is_known, Vector(1.34 * piece.clear_error / larger<Vector>(least, smallest_summand)), zero);
  result.centre = larger(minus_log(centre_opacity, larger<Vector>(centre_clear, smallest_summand)), Vector(0x1p-900));
  result.depth = result.scale * result.centre;
  const auto is_shallow = result.depth < Vector(deepest_at_once);
  result.is_plain = both(is_known, is_shallow);
  return result;
}

/// How many samples and nodes a piece needs, and what they leave out.
template <class Vector>
struct PointCounts {
  Vector samples{};
  Vector nodes{};
  Vector log2_interpolation{};  ///< of the error of f
  Vector log2_gauss{};          ///< of the error of the weights
};

template <int Degree, class Vector>
PointCounts<Vector> point_counts(const OpacityPiece<Degree, Vector>& piece,
                                 const PreparedOpacity<Degree, Vector>& prepared,
                                 const std::array<Vector, Degree + 1>& opacity,
                                 const std::array<Vector, Degree + 1>& clear, bool associated) {
  const auto log2_of = [](const Vector& x) { return log2_above(larger<Vector>(x, smallest_summand)); };
  // The coefficients of x' are off by so much through rounding.
  const auto rate = chebyshev_coefficients<Degree - 1>(prepared.rate);
  const Vector uncertainty = (4.0 * Degree + 12) * unit_roundoff * prepared.steepest;
  // But for their signs a and 1 - a have the same coefficients beyond the first: those of the smaller one have the
  // digits.
  Vector clear_reach{};
  Vector opacity_reach{};
  for (std::size_t j = 0; j <= Degree; ++j) {
    clear_reach = larger(clear_reach, magnitude(piece.clear[j]));
    opacity_reach = larger(opacity_reach, magnitude(piece.opacity[j]));
  }
  const auto is_faint = opacity_reach < clear_reach;
  const Vector smaller_reach = smaller(opacity_reach, clear_reach);
  const Vector clear_uncertainty = (4.0 * Degree + 12) * unit_roundoff * smaller_reach;
  const auto centre_low =
      larger(Vector(clear[0] - clear_uncertainty - 16 * unit_roundoff * clear_reach), Vector(smallest_summand));
  const Vector per_centre = 1.0 / centre_low;

  PointCounts<Vector> counts{.samples = 1e9,
                             .nodes = 1e9,
                             .log2_interpolation = log2_of(prepared.centre) + log2_interpolation_goal,
                             .log2_gauss = {}};
  const Vector sum = associated ? prepared.depth : piece.length;
  counts.log2_gauss = log2_of(sum) - log2_of(1 + prepared.depth) + log2_truncation_goal;
  for (const OpacityEllipse<Degree>& ellipse : opacity_ellipses<Degree>()) {
    const auto& a = ellipse.largest_chebyshev;
    Vector variation = clear_uncertainty * ellipse.chebyshev_sum;
    for (std::size_t k = 1; k <= Degree; ++k)
      variation = multiply_add(magnitude(select(is_faint, opacity[k], clear[k])), Vector(a[k]), variation);
    const Vector delta = rounding_slack * variation * per_centre;
    const auto is_inside = delta < Vector(largest_delta);
    const Vector samples =
        (log2_of(delta) + (ellipse.log2_interpolation - counts.log2_interpolation)) * ellipse.samples_per_bit + 1.0;
    counts.samples = smaller(counts.samples, select(is_inside, samples, Vector(1e9)));

    const Vector most = most_per_delta * delta;
    const Vector half_scale = 0.5 * rounding_slack * prepared.scale;
    const Vector exponent = half_scale * ((a[1] - 1) * prepared.centre + (1 + a[1]) * most);
    Vector largest = uncertainty * ellipse.chebyshev_sum;
    for (std::size_t k = 0; k < Degree; ++k) largest = multiply_add(Vector(magnitude(rate[k])), Vector(a[k]), largest);
    if (associated) {
      const Vector depth = half_scale * ((1 + a[1]) * (prepared.centre + most));
      largest *= smaller<Vector>(2, depth);
      // The integral of O by the same nodes is to have some 20 bits.
      largest = larger(largest, Vector(least_rate_share * smaller<Vector>(2, depth)));
    } else {
      // x is what it is at the front and the integral of x' from there.
      largest = piece.length * multiply_add(Vector(0.5 * (1 + a[1])), largest, prepared.reach);
    }
    const Vector log2_largest = multiply_add(Vector(log2_e_above), exponent, log2_of(largest));
    const Vector nodes = (log2_largest + (ellipse.log2_gauss - counts.log2_gauss)) * ellipse.nodes_per_bit;
    counts.nodes = smaller(counts.nodes, select(is_inside, nodes, Vector(1e9)));
  }
  return counts;
}

/// The first of a list of counts that is not below `least`; the list's size if all are.
template <std::size_t Count>
std::size_t first_not_below(const std::array<std::size_t, Count>& counts, double least) {
  std::size_t i = 0;
  while (i < Count && static_cast<double>(counts[i]) < least) ++i;
  return i;
}

/// What the samples and the nodes add up to.
template <class Vector>
struct OpacitySums {
  Vector opacity{};    ///< integral of -O du; for plain emission of T du
  Vector light{};      ///< of -x' O; for plain emission of x T
  Vector absolute{};   ///< of |x' O|; for plain emission of D T
  Vector depth{};      ///< D(1)
  Vector steep{};      ///< of |x'| T; not for plain emission
  Vector least = 1e9;  ///< the least sample of f
  Vector most{};       ///< the largest one
};

template <int Degree, class Vector>
OpacitySums<Vector> sum_nodes(const OpacityPiece<Degree, Vector>& piece,
                              const PreparedOpacity<Degree, Vector>& prepared, const DepthTable<Degree>& table,
                              bool associated) {
  OpacitySums<Vector> sums;
  const auto row_value = [](std::size_t i) { return [i](const auto& row) { return Vector(row[i]); }; };
  std::array<Vector, DepthTable<Degree>::most_samples> samples;
  for (std::size_t j = 0; j < table.sample_count; ++j) {
    Vector opacity{};
    Vector clear{};
    for (std::size_t k = 0; k <= Degree; ++k) {
      const Vector basis = table.signal_basis[k][j];
      opacity = multiply_add(basis, piece.opacity[k], opacity);
      clear = multiply_add(basis, piece.clear[k], clear);
    }
    const Vector f = minus_log(opacity, clear);
    sums.least = smaller(sums.least, f);
    sums.most = larger(sums.most, magnitude(f));
    samples[j] = prepared.scale * f;
  }
  const auto depth_at = [&](std::size_t row) {
    Vector even{};
    Vector odd{};
    for (std::size_t j = 0; j < table.sample_count; j += 2) {
      even = multiply_add(Vector(table.integrals[row][j]), samples[j], even);
      odd = multiply_add(Vector(table.integrals[row][j + 1]), samples[j + 1], odd);
    }
    return even + odd;
  };
  const NodeTable<Degree>& rule = *table.nodes;
  for (std::size_t i = 0; i < table.node_count; ++i) {
    const Vector depth = depth_at(i);
    const PowerOf2<Vector> transmittance(Vector(-std::numbers::log2e) * depth);
    const auto at = row_value(i);
    if (associated) {
      const Vector opacity_here = transmittance.less_1();
      const Vector rate = value_at(at, rule.weighted_rate_basis.data(), prepared.rate);
      const Vector term = rate * opacity_here;
      sums.steep = multiply_add(magnitude(rate), 1.0 + opacity_here, sums.steep);
      sums.opacity = multiply_add(at(rule.weights), opacity_here, sums.opacity);
      sums.light += term;
      sums.absolute += magnitude(term);
    } else {
      const Vector here = at(rule.weights) * transmittance.value();
      sums.opacity += here;
      sums.light = multiply_add(here, value_at(at, rule.signal_basis.data(), piece.x), sums.light);
      sums.absolute = multiply_add(here, magnitude(depth), sums.absolute);
    }
  }
  sums.depth = depth_at(table.node_count);
  return sums;
}

/// Pieces in lanes, or one piece in a double. `nodes` above most_points: not integrated, to be halved.
template <int Degree, class Vector>
[[gnu::flatten]] PieceIntegral<Vector> integrate_opacity(const OpacityPiece<Degree, Vector>& piece, bool associated) {
  constexpr double unit = unit_roundoff;
  const Vector too_many = most_points + 1;
  const auto clear = chebyshev_coefficients<Degree>(piece.clear);
  const auto opacity = chebyshev_coefficients<Degree>(piece.opacity);
  const auto prepared = prepare(piece, opacity[0], clear[0]);
  const auto counts = point_counts(piece, prepared, opacity, clear, associated);
  constexpr double most_samples = DepthTable<Degree>::most_samples;
  const auto can_be_done = both(prepared.is_plain, both(counts.samples < Vector(most_samples),
                                                        counts.nodes < Vector(static_cast<double>(most_nodes))));
  const std::size_t sample_index =
      first_not_below(depth_sample_counts, largest(select(can_be_done, counts.samples, Vector(1))));
  const std::size_t node_index =
      first_not_below(depth_node_counts, largest(select(can_be_done, counts.nodes, Vector(1))));
  const DepthTable<Degree>& table = depth_table<Degree>(sample_index, node_index);
  const auto sums = sum_nodes(piece, prepared, table, associated);

  const auto sample_count = static_cast<double>(table.sample_count);
  const auto node_count = static_cast<double>(table.node_count);
  // a and b err by Degree + 8 units of themselves. Where f is taken from b, which is below 0.71, that is as much of f
  // in all, and f is at least 0.34; where from a, it is at most 1.42 times that of f itself.
  const Vector magnified = smaller<Vector>(3, 1.0 / larger<Vector>(0.3, sums.least));
  // Relative error of the depths: that of the samples, the matrix and its products, the scale, the node's own rounding.
  const Vector relative = ((Degree + 8) * unit) * magnified + minus_log_error + ((0.5 * sample_count + 12) * unit);
  // What is not in proportion to them: samples that the matrix takes away, coefficients below 0, and what is left out.
  const Vector absolute =
      rounding_slack * prepared.scale *
      (relative * (2 * table.largest_negative * sums.most) + (6 * (Degree + 8) * unit) * prepared.below +
       table.largest_row * power_of_2_above(counts.log2_interpolation));
  const Vector from_x = rounding_slack * prepared.scale * table.largest_row * prepared.from_x;
  const Vector depth_error =
      rounding_slack * (relative * (magnitude(sums.depth) + 2 * prepared.scale * prepared.below) + absolute + from_x);

  PieceIntegral<Vector> result{.depth = sums.depth, .depth_error = depth_error};
  const PowerOf2<Vector> transmittance(Vector(-std::numbers::log2e) * sums.depth);
  const Vector x_1 = piece.x[Degree];
  // The exponent at a node errs by 3 units more.
  const Vector exponent = relative + 3 * unit;
  const Vector second_order = 1.0 + 2 * depth_error;
  Vector error;
  if (associated) {
    const Vector transmitted = 1.0 + sums.opacity + Vector(2 * least_rate_share);
    const Vector opacity_here = -transmittance.less_1();
    const Vector opacity_size = magnitude(opacity_here);
    result.weight_0 = multiply_add(Vector(1 - x_1), opacity_here, -sums.light);
    result.weight_1 = multiply_add(x_1, opacity_here, sums.light);
    // An error of D makes T times that of O, and D T is at most O.
    const Vector opacity_error = (PowerOf2<Vector>::error_less_1 + 4 * unit) * opacity_size +
                                 (exponent * magnitude(sums.depth) + absolute + from_x) * transmittance.value();
    // The integral of x d(T delta D) is that of x T (delta D' - tau delta D).
    const Vector light_from_x =
        from_x * smaller(sums.steep, prepared.reach * (transmitted + smaller(transmitted, opacity_size)));
    error = sums.absolute * (PowerOf2<Vector>::error_less_1 + exponent + (node_count + 4) * unit) +
            absolute * sums.steep + prepared.steepest * ((Degree + 4) * unit) * magnitude(sums.opacity) + light_from_x +
            prepared.reach * opacity_error + piece.x_error * opacity_size;
  } else {
    result.weight_0 = piece.length * (sums.opacity - sums.light);
    result.weight_1 = piece.length * sums.light;
    error = piece.length * (prepared.reach * (sums.opacity * (PowerOf2<Vector>::error +
                                                              (node_count + Degree + 17) * unit + absolute + from_x) +
                                              exponent * sums.absolute) +
                            sums.opacity * piece.x_error);
  }
  result.weight_error = rounding_slack * (rounding_slack * error * second_order + power_of_2_above(counts.log2_gauss));
  result.nodes = select(can_be_done, Vector(sample_count + node_count), too_many);
  // A sum out of range is no result.
  result.nodes = select(magnitude(result.weight_error) < Vector(0x1p1000), result.nodes, too_many);
  result.nodes = select(depth_error < Vector(largest_depth_error), result.nodes, too_many);
  return result;
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
