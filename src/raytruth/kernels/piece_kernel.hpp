#pragma once

#include "raytruth/kernels/exponential.hpp"
#include "raytruth/kernels/gauss_legendre.hpp"
#include "raytruth/kernels/lanes.hpp"
#include "raytruth/kernels/linear_piece.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

// For associated emission, O(u) = 1 - T(u) the opacity up to u and x' = dx/du,
//
//     weight_1 = integral of x dO = x(1) O(1) - integral of x' O du,  weight_0 = O(1) - weight_1
//
// by parts, which leaves neither tau nor x to be computed at the nodes. O is computed to a few units of itself however
// small it is, so faint pieces lose nothing by it.
//
// How the radius comes about. The integrand, x' O, or x T and (1 - x) T, is an entire function of u. Gauss's rule errs
// by at most 64/15 M rho^(-2n) / (1 - rho^-2) on [-1, 1], M the largest magnitude on the ellipse with foci -1, 1 and
// semiaxes' sum rho (L. N. Trefethen, Is Gauss quadrature better than Clenshaw-Curtis?, 2008, theorem 4.5). On that
// ellipse Chebyshev polynomial k is at most a_k = (rho^k + rho^-k) / 2, which bounds x and x' by their Chebyshev
// coefficients, and |T| = exp(-Re Q) by exp(-kappa_0 + sum_k |kappa_k| a_k), kappa those of the depth Q(u). The rule
// integrates polynomials of degree 2n - 1 exactly, so that for x' O all of x' and x' Q may be left out of M: what
// remains is at most |x'| |Q|^2 / 2 or |x'|, times the largest |T|. The bound holds for every rho; a few fixed ones are
// tried and the smallest n is taken.
//
// Rounding: in Bernstein form x, tau and Q are sums of terms of one sign as long as x stays in [0, 1], so each comes
// with a relative error of a few units, and exp(-Q) with Q times that, O with no more than that; x' has terms of both
// signs, so the sum of |x' O| over the nodes is carried along.

namespace raytruth::inline RAYTRUTH_LEVEL {

constexpr double log2_truncation_goal = -50.5;  ///< log2 of the truncation error, relative to the integral
constexpr double deepest_at_once = 32;          ///< optical depth in one go; deeper pieces are halved
constexpr double largest_depth_error = 1;       ///< of an optical depth; beyond it, the crude bound
constexpr double smallest_summand = 0x1p-1000;
constexpr double rounding_slack = 1 + 0x1p-20;  ///< second-order terms, and the rounding of the error bounds themselves
constexpr double least_rate_share = 0x1p-24;    ///< of a largest |x'| where the truncation error is bounded
constexpr double log2_e_above = 1.4426951;      // rounded up

/// Rounding of the depth, relative: a term with 1 - x, two products, a sum and the length's share, 6; partial sums,
/// Degree; the length, 4.
template <int Degree>
constexpr double depth_units = Degree + 10;

/// Rounding of the exponent at a node, relative: the factor -log2(e), 2; the basis and the sum of products, Degree + 2.
template <int Degree>
constexpr double exponent_units = depth_units<Degree> + Degree + 4;

template <int Degree>
using Matrix = std::array<std::array<double, Degree + 1>, Degree + 1>;

constexpr double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// [k][j]: Chebyshev coefficient k on [-1, 1] of Bernstein polynomial j on [0, 1]. Exact: all are dyadic and short.
///     B_j(u) = sum_m (-1)^(m-j) C(n, m) C(m, j) u^m,  u^m = 2^(1-2m) (C(2m, m)/2 + sum_{k>0} C(2m, m-k) T_k(2u - 1)).
template <int Degree>
constexpr Matrix<Degree> chebyshev_from_bernstein() {
  Matrix<Degree> matrix{};
  for (int j = 0; j <= Degree; ++j)
    for (int m = j; m <= Degree; ++m) {
      double factor = 2 * binomial(Degree, m) * binomial(m, j) * ((m - j) % 2 == 0 ? 1 : -1);
      for (int i = 0; i < m; ++i) factor /= 4;
      for (int k = 0; k <= m; ++k)
        matrix[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] +=
            factor * binomial(2 * m, m - k) * (k == 0 ? 0.5 : 1);
    }
  return matrix;
}

/// Numbers of an ellipse.
template <int Degree>
struct Ellipse {
  explicit Ellipse(double rho)
      : log2_factor(std::log2(rounding_slack * 64 / 15 / (1 - 1 / (rho * rho)))),
        nodes_per_bit(rounding_slack / (2 * std::log2(rho))) {
    for (int k = 0; k <= Degree + 1; ++k) {
      const double a = rounding_slack * (std::pow(rho, k) + std::pow(rho, -k)) / 2;
      largest_chebyshev[static_cast<std::size_t>(k)] = a;
      chebyshev_sum += a;
    }
    first_squared = rounding_slack * largest_chebyshev[1] * largest_chebyshev[1] / largest_chebyshev[2];
  }

  std::array<double, Degree + 2> largest_chebyshev{};  ///< a_k
  double chebyshev_sum = 0;                            ///< of all a_k
  double first_squared;                                ///< a_1^2 / a_2
  double log2_factor;                                  ///< of 64/15 / (1 - rho^-2)
  double nodes_per_bit;                                ///< 1 / (2 log2(rho))
};

/// Two ellipses for every octave of the optical depth. Near rho = 10 depth^-0.26 random pieces need the fewest nodes;
/// the better one of two about there is within 0.4 nodes of the best of twenty, 0.2 on average.
template <int Degree>
class Ellipses {
 public:
  static constexpr int first_octave = -12;
  static constexpr int last_octave = 5;

  Ellipses() {
    for (int octave = first_octave; octave <= last_octave; ++octave) {
      const double rho = 10 * std::exp2(-0.26 * (octave + 0.5));
      pairs_.push_back({Ellipse<Degree>(rho / 1.3), Ellipse<Degree>(rho * 1.3)});
    }
  }

  const std::array<Ellipse<Degree>, 2>& at(double depth) const {
    const std::int64_t octave = (to_bits(depth) >> 52) - 1023;
    const std::int64_t nearest = octave < first_octave ? first_octave : octave > last_octave ? last_octave : octave;
    return pairs_[static_cast<std::size_t>(nearest - first_octave)];
  }

 private:
  std::vector<std::array<Ellipse<Degree>, 2>> pairs_;
};

template <int Degree>
const Ellipses<Degree>& ellipses() {
  static const Ellipses<Degree> table;
  return table;
}

/// Bernstein coefficients of what is evaluated at the nodes.
template <int Degree, class Vector>
struct Integrand {
  std::array<Vector, Degree + 1> x{};
  std::array<Vector, Degree> rate{};          ///< of x'
  std::array<Vector, Degree + 1> exponent{};  ///< of -log2(e) Q, but for the first one, 0
};

/// What follows from the coefficients of a piece before any quadrature.
template <int Degree, class Vector>
struct Prepared {
  Integrand<Degree, Vector> integrand;
  Vector reach{};                              ///< of |x| and |1 - x|
  Vector steepest{};                           ///< of |x'|
  Vector slope{};                              ///< |tau_1 - tau_0|
  Vector below{};                              ///< how far the terms of tau can be negative
  Vector depth{};                              ///< Q(1)
  Vector depth_below{};                        ///< how far the depth can be negative, twice
  Vector depth_from_x{};                       ///< error of the depth by that of x
  decltype(Vector{} < Vector{}) is_shallow{};  ///< else no exponent is computed, and the piece has to be halved
};

template <int Degree, class Vector>
Prepared<Degree, Vector> prepare(const LinearPiece<Degree, Vector>& piece) {
  Prepared<Degree, Vector> result;
  const Vector zero{};
  const Vector share = piece.length * (1.0 / (Degree + 1));
  Vector lowest = piece.x[0];
  Vector highest = piece.x[0];
  std::array<Vector, Degree + 1> depth;  // Bernstein coefficients, but for the first one, 0
  for (std::size_t j = 0; j <= Degree; ++j) {
    const Vector x = piece.x[j];
    const Vector extinction = multiply_add(piece.extinction_at_1, x, piece.extinction_at_0 * (1.0 - x));
    result.depth = depth[j] = multiply_add(share, extinction, result.depth);
    result.integrand.x[j] = x;
    if (j == 0) continue;
    lowest = smaller(lowest, x);
    highest = larger(highest, x);
    const Vector rate = Degree * (x - piece.x[j - 1]);
    result.steepest = larger(result.steepest, magnitude(rate));
    result.integrand.rate[j - 1] = rate;
  }
  result.reach = larger(highest, Vector(1.0 - lowest));
  result.below = multiply_add(piece.extinction_at_0, larger(zero, Vector(highest - 1.0)),
                              piece.extinction_at_1 * larger(zero, Vector(zero - lowest)));
  result.depth_below = 2 * piece.length * result.below;
  result.is_shallow = result.depth + result.depth_below < Vector(deepest_at_once);
  const Vector factor = select(result.is_shallow, Vector(-std::numbers::log2e), zero);
  for (std::size_t j = 0; j <= Degree; ++j) result.integrand.exponent[j] = factor * depth[j];
  result.slope = magnitude(piece.extinction_at_1 - piece.extinction_at_0);
  result.depth_from_x = piece.length * result.slope * piece.x_error;
  return result;
}

/// log2 of the truncation error that is as good as none: a share of the weights' sum, 1 - exp(-D) >= D / (1 + D) or the
/// integral of T >= length / (1 + D); where tau nearly vanishes, of what the extinctions at 0 and 1 would make it.
template <int Degree, class Vector>
Vector log2_goal(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared, bool associated) {
  const auto log2_of = [](const Vector& x) { return log2_above(larger<Vector>(x, smallest_summand)); };
  const Vector most_depth = piece.length * larger(piece.extinction_at_0, piece.extinction_at_1);
  const Vector sum = associated ? larger(prepared.depth, Vector(0x1p-40 * most_depth)) : piece.length;
  return log2_of(sum) - log2_of(1 + prepared.depth) + log2_truncation_goal;
}

template <int Degree, class Vector>
std::array<Vector, Degree + 1> chebyshev_coefficients(const std::array<Vector, Degree + 1>& bernstein) {
  constexpr auto matrix = chebyshev_from_bernstein<Degree>();
  std::array<Vector, Degree + 1> result{};
  for (std::size_t k = 0; k <= Degree; ++k)
    for (std::size_t j = 0; j <= Degree; ++j) result[k] = multiply_add(Vector(matrix[k][j]), bernstein[j], result[k]);
  return result;
}

/// Chebyshev coefficients of the derivative: c_(k-1) = c_(k+1) + 2 k (those of the polynomial)_k, and c_0 half of that.
template <int Degree, class Vector>
std::array<Vector, Degree> derivative(const std::array<Vector, Degree + 1>& chebyshev) {
  std::array<Vector, Degree> result{};
  for (std::size_t k = Degree; k > 0; --k) {
    result[k - 1] = 2.0 * static_cast<double>(k) * chebyshev[k];
    if (k + 1 < Degree) result[k - 1] += result[k + 1];
  }
  result[0] *= 0.5;
  return result;
}

/// The number of nodes, rounded up, by which the truncation error falls to 2^log2_goal by one of the ellipses.
///
/// With c = |cos(theta)| the first two terms of -Re Q are at most |kappa_1| a_1 c - kappa_2 a_2 (2 c^2 - 1), which is
/// largest at c = 1, or for 4 kappa_2 a_2 > |kappa_1| a_1 before: (kappa_1 a_1)^2 / (8 kappa_2 a_2) + kappa_2 a_2.
template <int Degree, class Vector>
Vector nodes_for(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared, bool associated,
                 const Vector& log2_goal, const std::array<Ellipse<Degree>, 2>& pair) {
  const auto chebyshev = chebyshev_coefficients<Degree>(piece.x);
  const auto rate = derivative<Degree>(chebyshev);
  const Vector half = 0.5 * piece.length;
  const Vector half_slope = half * (piece.extinction_at_1 - piece.extinction_at_0);
  const Vector half_extinction = half * piece.extinction_at_0;
  // Coefficients are off by so much through rounding, those of x' by at most Degree (Degree + 1) times that.
  const Vector uncertainty = (4.0 * Degree + 8) * unit_roundoff * prepared.reach;
  const Vector depth_uncertainty = (magnitude(half_slope) + half_extinction) * uncertainty;

  std::array<Vector, Degree + 2> kappa{};
  for (std::size_t k = 1; k <= Degree + 1; ++k) {
    Vector twice_k = k == 1 ? Vector(2 * multiply_add(half_slope, chebyshev[0], half_extinction))
                            : Vector(half_slope * chebyshev[k - 1]);
    if (k + 1 <= Degree) twice_k -= half_slope * chebyshev[k + 1];
    kappa[k] = twice_k * (0.5 / static_cast<double>(k));
    // Q vanishes at -1, which gives kappa_0.
    kappa[0] += k % 2 == 1 ? kappa[k] : Vector(-kappa[k]);
  }
  const Vector first_squared_over_second = kappa[1] * kappa[1] / (8 * kappa[2]);

  auto nodes = Vector(1e9);
  for (const Ellipse<Degree>& ellipse : pair) {
    const auto& a = ellipse.largest_chebyshev;
    const Vector first = a[1] * magnitude(kappa[1]);
    const Vector second = a[2] * kappa[2];
    const Vector first_two =
        select(first < 4 * second, multiply_add(first_squared_over_second, Vector(ellipse.first_squared), second),
               Vector(first - second));
    Vector others = depth_uncertainty * (ellipse.chebyshev_sum + Degree);
    for (std::size_t k = 3; k <= Degree + 1; ++k)
      others = multiply_add(Vector(magnitude(kappa[k])), Vector(a[k]), others);
    const Vector exponent = first_two + (others - kappa[0]);

    Vector largest{};
    if (associated) {
      for (std::size_t k = 0; k < Degree; ++k)
        largest = multiply_add(Vector(magnitude(rate[k])), Vector(a[k]), largest);
      largest += uncertainty * (Degree * (Degree + 1) * ellipse.chebyshev_sum);
      // It is no less, for the integral of O by the same nodes is to have some 20 bits.
      largest = larger<Vector>(largest, least_rate_share);
      const Vector depth = (magnitude(kappa[0]) + first) + (magnitude(second) + others);
      largest *= smaller<Vector>(1, multiply_add(Vector(0.5 * depth), depth, Vector(smallest_summand)));
    } else {
      largest = larger(magnitude(chebyshev[0]), magnitude(Vector(1 - chebyshev[0])));
      for (std::size_t k = 1; k <= Degree; ++k)
        largest = multiply_add(Vector(magnitude(chebyshev[k])), Vector(a[k]), largest);
      largest = half * multiply_add(uncertainty, Vector(ellipse.chebyshev_sum), largest);
    }
    const Vector log2_largest = multiply_add(Vector(log2_e_above), exponent, log2_above(largest));
    nodes = smaller(nodes, Vector((log2_largest + (ellipse.log2_factor - log2_goal)) * ellipse.nodes_per_bit));
  }
  // The number is made an integer by way of the magic number; the half makes up for rounding to nearest. Degree + 1
  // nodes at least integrate x' Q, of degree 2 Degree, exactly.
  return (larger<Vector>(Degree + 1, nodes) + 0.5 + round_to_integer) - round_to_integer;
}

template <int Degree>
Integrand<Degree, Lanes> in_all_lanes(const Integrand<Degree, double>& integrand) {
  Integrand<Degree, Lanes> result;
  std::copy(integrand.x.begin(), integrand.x.end(), result.x.begin());
  std::copy(integrand.rate.begin(), integrand.rate.end(), result.rate.begin());
  std::copy(integrand.exponent.begin(), integrand.exponent.end(), result.exponent.begin());
  return result;
}

/// A polynomial at a node, or at nodes side by side: `at` says what a row has there.
template <std::size_t Count, class Vector, class At>
Vector value_at(const At& at, const NodeRow* basis, const std::array<Vector, Count>& coefficients) {
  Vector result{};
  for (std::size_t j = 0; j < Count; ++j) result = multiply_add(at(basis[j]), coefficients[j], result);
  return result;
}

/// Sums over the nodes for associated emission.
template <int Degree, class Vector>
struct AssociatedSums {
  static constexpr bool is_associated = true;

  Vector opacity{};   ///< integral of -O du
  Vector light{};     ///< of -x' O
  Vector absolute{};  ///< of |x' O|

  template <class At>
  void add(const NodeTable<Degree>& table, const Integrand<Degree, Vector>& integrand, const At& at) {
    const Vector rate = value_at(at, table.weighted_rate_basis.data(), integrand.rate);
    const Vector opacity_here = PowerOf2(value_at(at, &table.depth_basis[1], integrand.exponent)).less_1();
    const Vector term = rate * opacity_here;
    opacity = multiply_add(at(table.weights), opacity_here, opacity);
    light += term;
    absolute += magnitude(term);
  }
};

template <int Degree, class Vector>
AssociatedSums<Degree, Vector> operator+(const AssociatedSums<Degree, Vector>& a,
                                         const AssociatedSums<Degree, Vector>& b) {
  return {a.opacity + b.opacity, a.light + b.light, a.absolute + b.absolute};
}

template <int Degree>
AssociatedSums<Degree, double> total(const AssociatedSums<Degree, Lanes>& sums) {
  return {sum(sums.opacity), sum(sums.light), sum(sums.absolute)};
}

/// Sums over the nodes for plain emission.
template <int Degree, class Vector>
struct PlainSums {
  static constexpr bool is_associated = false;

  Vector transmitted{};  ///< integral of T du
  Vector light{};        ///< of x T
  Vector exponent{};     ///< of -log2(e) Q T

  template <class At>
  void add(const NodeTable<Degree>& table, const Integrand<Degree, Vector>& integrand, const At& at) {
    const Vector exponent_here = value_at(at, &table.depth_basis[1], integrand.exponent);
    const Vector here = at(table.weights) * PowerOf2(exponent_here).value();
    transmitted += here;
    light = multiply_add(here, value_at(at, table.signal_basis.data(), integrand.x), light);
    exponent = multiply_add(here, exponent_here, exponent);
  }
};

template <int Degree, class Vector>
PlainSums<Degree, Vector> operator+(const PlainSums<Degree, Vector>& a, const PlainSums<Degree, Vector>& b) {
  return {a.transmitted + b.transmitted, a.light + b.light, a.exponent + b.exponent};
}

template <int Degree>
PlainSums<Degree, double> total(const PlainSums<Degree, Lanes>& sums) {
  return {sum(sums.transmitted), sum(sums.light), sum(sums.exponent)};
}

/// The weights and their error, but for truncation and second-order terms.
template <class Vector>
struct Weights {
  Vector weight_0{};
  Vector weight_1{};
  Vector error{};
};

/// `additions`: those that a node's term goes through in the sums.
template <int Degree, class Vector>
Weights<Vector> weights_of(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared,
                           const AssociatedSums<Degree, Vector>& sums, double additions) {
  constexpr double unit = unit_roundoff;
  constexpr double exponent_unit = exponent_units<Degree> * unit;
  const auto& [integrand, reach, steepest, slope, below, depth, depth_below, depth_from_x, is_shallow] = prepared;
  const PowerOf2<Vector> transmittance(integrand.exponent[Degree]);
  const Vector opacity = -transmittance.less_1();
  const Vector opacity_size = magnitude(opacity);
  const Vector x_1 = piece.x[Degree];

  // A node's O errs by the exponent's error times |Q| T <= |O| (1 + depth_below).
  const Vector term_error = PowerOf2<Vector>::error_less_1 + exponent_unit * (1 + depth_below) + (additions + 2) * unit;
  const Vector transmitted = 1 + sums.opacity + Vector(2 * least_rate_share);  // the integral of T du, not below it
  // |O| is O, or where that is negative at most T depth_below.
  const Vector opacities = 2 * depth_below * transmitted - sums.opacity;
  const Vector rate_error = (Degree + 4) * unit * opacities + exponent_unit * depth_below * transmitted;
  const Vector opacity_error = (PowerOf2<Vector>::error_less_1 + 4 * unit) * opacity_size +
                               exponent_unit * (depth + depth_below) * transmittance.value();
  // The error that comes from x, from tau and from T: these errors meet the integrals of tau T, of T, and of tau T u,
  // which is above neither of them.
  const Vector growth = 1 + 2 * depth_from_x;
  const Vector negative = 2 * growth * below * piece.length * transmitted;
  const Vector from_x = piece.x_error * (opacity_size + negative + 8 * depth_from_x * (1 + transmitted)) +
                        reach * growth * depth_from_x * (transmitted + smaller(transmitted, opacity_size) + negative);
  return {multiply_add(Vector(1 - x_1), opacity, -sums.light), multiply_add(x_1, opacity, sums.light),
          sums.absolute * term_error + steepest * rate_error + reach * opacity_error + from_x};
}

template <int Degree, class Vector>
Weights<Vector> weights_of(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared,
                           const PlainSums<Degree, Vector>& sums, double additions) {
  constexpr double unit = unit_roundoff;
  const auto& [integrand, reach, steepest, slope, below, depth, depth_below, depth_from_x, is_shallow] = prepared;
  // x at a node errs by Degree + 5 units; its product with weight and T, the length and the difference by 12.
  const Vector transmitted = sums.transmitted;
  const Vector depth_sum = 3 * depth_below * transmitted - std::numbers::ln2 * sums.exponent;
  const Vector sum_error = transmitted * (PowerOf2<Vector>::error + (additions + (Degree + 17)) * unit) +
                           exponent_units<Degree> * unit * depth_sum;
  // The error that comes from x and from T: the integral of T u du is at most half of that of T where T falls, and
  // exp(depth_below) times that where it need not.
  const auto share = smaller<Vector>(1, 0.5 + depth_below);
  const Vector from_x = transmitted * (1 + 2 * depth_from_x) * (piece.x_error + reach * share * depth_from_x);
  return {piece.length * (transmitted - sums.light), piece.length * sums.light,
          piece.length * (reach * sum_error + from_x)};
}

template <int Degree, class Vector>
PieceIntegral<Vector> finish(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared,
                             const Weights<Vector>& weights, bool associated, const Vector& log2_truncation) {
  const Vector depth_rounding = depth_units<Degree> * unit_roundoff * (prepared.depth + 2 * prepared.depth_below);
  const Vector depth_error = rounding_slack * (depth_rounding + prepared.depth_from_x);
  // This holds for an error of the depth above 1, and for a sum out of range: the integrals of tau T and T are at most
  // 1 and length.
  const Vector most = associated ? Vector(1) : piece.length;
  const Vector crude = magnitude(weights.weight_0) + magnitude(weights.weight_1) + most * prepared.reach;
  const Vector error = weights.error + power_of_2_above(log2_truncation);
  return {.weight_0 = weights.weight_0,
          .weight_1 = weights.weight_1,
          .weight_error = rounding_slack * select(depth_error < Vector(largest_depth_error), error, crude),
          .depth = prepared.depth,
          .depth_error = depth_error};
}

/// `first`, or as many steps more as reach `least`. Found by branches: a processor that foresees them takes up the
/// nodes without waiting for what says how many they are, which is a third of the time of a piece.
inline std::size_t foreseen_count(std::size_t first, std::size_t step, double least) {
  std::size_t count = first;
  while (static_cast<double>(count) < least) count += step;
  return count;
}

/// Pieces in lanes, or one piece in a double: node after node. `nodes` above most_nodes: not integrated.
template <template <int, class> class Sums, int Degree, class Vector>
[[gnu::flatten]] PieceIntegral<Vector> integrate_node_by_node(const LinearPiece<Degree, Vector>& piece) {
  constexpr bool associated = Sums<Degree, Vector>::is_associated;
  constexpr double too_many = most_nodes + 1;
  const auto prepared = prepare(piece);
  const Vector goal_here = log2_goal(piece, prepared, associated);
  const double depth = largest(select(prepared.is_shallow, prepared.depth, Vector(0)));
  const Vector fewest = nodes_for(piece, prepared, associated, goal_here, ellipses<Degree>().at(depth));
  const Vector nodes = select(prepared.is_shallow, smaller<Vector>(fewest, too_many), Vector(too_many));
  // Pieces that are too deep are done again by the caller; they do not make the others pay.
  const double most = largest(select(nodes < Vector(too_many), nodes, Vector(1)));
  const std::size_t count = foreseen_count(Degree + 1, 2, most);

  const auto& table = node_table<Degree>(count);
  Sums<Degree, Vector> even;
  Sums<Degree, Vector> odd;
  for (std::size_t i = 0; i < count; i += 2) {
    even.add(table, prepared.integrand, [i](const NodeRow& row) { return Vector(row[i]); });
    odd.add(table, prepared.integrand, [i](const NodeRow& row) { return Vector(row[i + 1]); });
  }

  const double additions = static_cast<double>(count) / 2 + 1;
  auto result = finish(piece, prepared, weights_of(piece, prepared, even + odd, additions), associated, goal_here);
  result.nodes = select(nodes < Vector(too_many), Vector(static_cast<double>(count)), nodes);
  return result;
}

/// One piece, its nodes in lanes, which all are filled.
template <template <int, class> class Sums, int Degree>
[[gnu::flatten]] PieceIntegral<> integrate_nodes_side_by_side(const LinearPiece<Degree>& piece) {
  constexpr bool associated = Sums<Degree, Lanes>::is_associated;
  const auto prepared = prepare(piece);
  const double goal_here = log2_goal(piece, prepared, associated);
  const double fewest = nodes_for(piece, prepared, associated, goal_here, ellipses<Degree>().at(prepared.depth));
  if (!(fewest <= most_nodes && prepared.is_shallow)) return {.nodes = most_nodes + 1};
  const std::size_t nodes = foreseen_count(lane_count, lane_count, fewest);

  const auto& table = node_table<Degree>(nodes);
  const auto integrand = in_all_lanes(prepared.integrand);
  Sums<Degree, Lanes> sums;
  for (std::size_t i = 0; i < nodes; i += lane_count)
    sums.add(table, integrand, [i](const NodeRow& row) { return Lanes::load(&row[i]); });

  constexpr std::size_t additions_of_lanes = 3;
  const std::size_t additions_in_lanes = nodes / lane_count;
  const auto additions = static_cast<double>(additions_in_lanes + additions_of_lanes);
  auto result = finish(piece, prepared, weights_of(piece, prepared, total(sums), additions), associated, goal_here);
  result.nodes = static_cast<double>(nodes);
  return result;
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
