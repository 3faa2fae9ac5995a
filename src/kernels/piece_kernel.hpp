#pragma once

#include "kernels/exponential.hpp"
#include "kernels/gauss_legendre.hpp"
#include "kernels/lanes.hpp"
#include "kernels/linear_piece.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

// How the radius comes about. The integrand (1 - x) r T, or x r T, is an entire function of u. Gauss's rule errs by at
// most 64/15 M rho^(-2n) / (1 - rho^-2) on [-1, 1], M the largest magnitude on the ellipse with foci -1, 1 and
// semiaxes' sum rho (L. N. Trefethen, Is Gauss quadrature better than Clenshaw-Curtis?, 2008, theorem 4.5). On that
// ellipse Chebyshev polynomial k is at most a_k = (rho^k + rho^-k) / 2, which bounds x and tau by their Chebyshev
// coefficients, and |T| = exp(-Re Q) by exp(-kappa_0 + sum_k |kappa_k| a_k), kappa those of the depth Q(u). The bound
// holds for every rho; a few fixed ones are tried and the smallest n is taken.
//
// Rounding: in Bernstein form x, tau and Q are sums of terms of one sign as long as x stays in [0, 1], so each comes
// with a relative error of a few units, and exp(-Q) with Q times that; the sum of Q T r over the nodes is carried
// along.

namespace raytruth::inline RAYTRUTH_LEVEL {

constexpr double goal = -50.5;       ///< log2 of the truncation error, relative to the integral
constexpr double deepest = 32;       ///< optical depth in one go; deeper pieces are halved
constexpr double opaque_depth = 92;  ///< exp(-92) < 2^-132: what lies behind is bounded, not computed
constexpr double most_error = 1;     ///< of an optical depth; beyond it, the crude bound
constexpr double smallest = 0x1p-1000;
constexpr double slack = 1 + 0x1p-20;  ///< second-order terms, and the rounding of the error bounds themselves
constexpr double log2_e = 1.4426951;   // rounded up

/// Rounding of the depth at a node, relative: coefficients, their partial sums, the basis, the sum, the length.
template <int Degree>
constexpr double depth_units = 2 * Degree + 15;

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
      : log2_factor(std::log2(slack * 64 / 15 / (1 - 1 / (rho * rho)))), nodes_per_bit(slack / (2 * std::log2(rho))) {
    for (int k = 0; k <= Degree + 1; ++k)
      largest_chebyshev[static_cast<std::size_t>(k)] = slack * (std::pow(rho, k) + std::pow(rho, -k)) / 2;
  }

  std::array<double, Degree + 2> largest_chebyshev{};  ///< a_k
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

/// What follows from the coefficients of a piece before any quadrature.
template <int Degree, class Vector>
struct Prepared {
  Vector reach{};                               ///< of |x| and |1 - x|
  Vector slope{};                               ///< |tau_1 - tau_0|
  Vector below{};                               ///< how far the terms of tau can be negative
  Vector depth_below{};                         ///< the same of the depth
  std::array<Vector, Degree + 1> extinction{};  ///< Bernstein coefficients of tau
  std::array<Vector, Degree + 2> depth{};       ///< those of Q
  Vector depth_from_x{};                        ///< error of the depth by that of x
};

template <int Degree, class Vector>
Prepared<Degree, Vector> prepare(const LinearPiece<Degree, Vector>& piece) {
  Prepared<Degree, Vector> result;
  const Vector zero{};
  const Vector scale = piece.length * (1.0 / (Degree + 1));
  Vector below_sum{};
  for (std::size_t j = 0; j <= Degree; ++j) {
    const Vector x = piece.x[j];
    const Vector y = 1.0 - x;
    result.reach = larger(result.reach, larger(magnitude(x), magnitude(y)));
    const Vector below = piece.extinction_at_0 * larger(zero, -y) + piece.extinction_at_1 * larger(zero, -x);
    result.below = larger(result.below, below);
    below_sum += below;
    result.extinction[j] = piece.extinction_at_0 * y + piece.extinction_at_1 * x;
    result.depth[j + 1] = result.depth[j] + scale * result.extinction[j];
  }
  result.depth_below = 2 * scale * below_sum;
  result.slope = magnitude(piece.extinction_at_1 - piece.extinction_at_0);
  result.depth_from_x = piece.length * result.slope * piece.x_error;
  return result;
}

/// log2 of the truncation error that is as good as none: a share of the integral, for which 1 - exp(-D) >= D / (1 + D);
/// where tau nearly vanishes, of what the extinctions at 0 and 1 would make it.
template <int Degree, class Vector>
Vector log2_goal(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared, bool associated) {
  const auto log2_of = [](const Vector& x) { return log2_above(larger<Vector>(x, smallest)); };
  const Vector depth = prepared.depth[Degree + 1];
  const Vector largest_extinction = larger(piece.extinction_at_0, piece.extinction_at_1);
  const Vector log2_density =
      associated ? larger(Vector(log2_of(depth) - log2_of(piece.length)), log2_of(0x1p-40 * largest_extinction))
                 : Vector(0);
  return log2_density - log2_of(1 + depth) + goal;
}

template <int Degree, class Vector>
std::array<Vector, Degree + 1> chebyshev_coefficients(const LinearPiece<Degree, Vector>& piece) {
  constexpr auto matrix = chebyshev_from_bernstein<Degree>();
  std::array<Vector, Degree + 1> result{};
  for (std::size_t k = 0; k <= Degree; ++k)
    for (std::size_t j = 0; j <= Degree; ++j) result[k] += matrix[k][j] * piece.x[j];
  return result;
}

/// The number of nodes, rounded up, by which the truncation error falls to 2^log2_goal by one of the ellipses.
///
/// With c = |cos(theta)| the first two terms of -Re Q are at most |kappa_1| a_1 c - kappa_2 a_2 (2 c^2 - 1), which is
/// largest at c = 1, or for kappa_2 > 0 before, at |kappa_1| a_1 / (4 kappa_2 a_2).
template <int Degree, class Vector>
Vector nodes_for(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared, bool associated,
                 const Vector& log2_goal, const std::array<Ellipse<Degree>, 2>& pair) {
  const auto chebyshev = chebyshev_coefficients(piece);
  // Coefficients of the x that is meant, not only of the one at hand.
  const Vector uncertainty = (4.0 * Degree + 8) * unit_roundoff * prepared.reach + 2 * piece.x_error;
  const Vector half = 0.5 * piece.length;
  const Vector slope = piece.extinction_at_1 - piece.extinction_at_0;
  const Vector extinction_0 = piece.extinction_at_0 * (1 - chebyshev[0]) + piece.extinction_at_1 * chebyshev[0];
  const Vector depth_uncertainty = half * (prepared.slope + piece.extinction_at_0) * uncertainty;
  const Vector x_0 = larger(magnitude(chebyshev[0]), magnitude(Vector(1 - chebyshev[0]))) + uncertainty;
  const Vector tau_0 = magnitude(extinction_0) + prepared.slope * uncertainty + Vector(smallest);

  std::array<Vector, Degree + 2> kappa{};
  for (std::size_t k = 1; k <= Degree + 1; ++k) {
    const Vector before = k == 1 ? 2 * extinction_0 : slope * chebyshev[k - 1];
    const Vector after = k + 1 <= Degree ? slope * chebyshev[k + 1] : Vector{};
    kappa[k] = half * (before - after) * (0.5 / static_cast<double>(k));
    // Q vanishes at -1, which gives kappa_0.
    kappa[0] += k % 2 == 1 ? kappa[k] : Vector(-kappa[k]);
    kappa[0] -= depth_uncertainty;
  }

  auto nodes = Vector(1e9);
  const Vector kappa_1 = magnitude(kappa[1]);
  const Vector ratio = kappa_1 / (4 * kappa[2]);
  for (const Ellipse<Degree>& ellipse : pair) {
    const auto& a = ellipse.largest_chebyshev;
    Vector x_part{};
    for (std::size_t k = 1; k <= Degree; ++k)
      x_part = multiply_add(Vector(magnitude(chebyshev[k]) + uncertainty), Vector(a[k]), x_part);
    const Vector first = a[1] * kappa_1;
    const Vector second = a[2] * kappa[2];
    const Vector c = select(first < 4 * second, Vector(ratio * (a[1] / a[2])), Vector(1));
    Vector exponent = multiply_add(first, c, multiply_add(second, 1 - 2 * c * c, (a[1] + a[2]) * depth_uncertainty));
    for (std::size_t k = 3; k <= Degree + 1; ++k)
      exponent = multiply_add(Vector(magnitude(kappa[k]) + depth_uncertainty), Vector(a[k]), exponent);
    Vector log2_largest = log2_above(Vector(x_0 + x_part)) + log2_e * (exponent - kappa[0]) + ellipse.log2_factor;
    if (associated) log2_largest += log2_above(multiply_add(prepared.slope, x_part, tau_0));
    nodes = smaller(nodes, Vector((log2_largest - log2_goal) * ellipse.nodes_per_bit));
  }
  // As an integer, by way of the magic number; the half makes up for rounding to nearest.
  return (larger<Vector>(1, nodes) + 0.5 + 0x1.8p52) - 0x1.8p52;
}

/// Sums over nodes of weight times T times what the names say.
template <class Vector>
struct Sums {
  Vector weight_0{};
  Vector weight_1{};
  Vector transmitted{};  ///< 1
  Vector depth{};        ///< r Q
  Vector position{};     ///< r u

  template <class Number>
  void add(bool associated, const Number& node, const Number& weight, const Vector& x, const Vector& extinction,
           const Vector& depth_here) {
    const Vector here = weight * exponential(Vector(-depth_here));
    const Vector density = associated ? Vector(here * extinction) : here;
    weight_0 = multiply_add(density, Vector(1 - x), weight_0);
    weight_1 = multiply_add(density, x, weight_1);
    transmitted += here;
    depth = multiply_add(density, depth_here, depth);
    position = multiply_add(density, Vector(node), position);
  }
};

/// `additions`: those that a node's term goes through in the sums.
template <int Degree, class Vector>
PieceIntegral<Vector> finish(const LinearPiece<Degree, Vector>& piece, const Prepared<Degree, Vector>& prepared,
                             bool associated, const Sums<Vector>& sums, double additions,
                             const Vector& log2_truncation) {
  constexpr double unit = unit_roundoff;
  const Vector zero{};
  const auto one = Vector(1);
  const Vector whole = prepared.depth[Degree + 1];
  const auto& [reach, slope, below, depth_below, extinction, depth, depth_from_x] = prepared;

  PieceIntegral<Vector> result;
  result.weight_0 = piece.length * sums.weight_0;
  result.weight_1 = piece.length * sums.weight_1;
  result.depth = whole;
  const Vector depth_rounding = depth_units<Degree> * unit * (whole + 2 * depth_below);
  result.depth_error = slack * (depth_rounding + depth_from_x);

  // Sums of magnitudes: those at hand, unless a term is negative.
  const Vector sum = sums.weight_0 + sums.weight_1 + 2 * sums.transmitted * below;
  const Vector depth_sum = select(zero < depth_below, sum * (whole + 2 * depth_below), sums.depth);
  const Vector position_sum = select(zero < depth_below, sum, sums.position);
  // x at a node errs by Degree + 5 units, tau by Degree + 8, their product with weight and T, and the sum, by
  // additions + 6.
  Vector error = sum * (piece.x_error + reach * (exponential_error + (additions + (2.0 * Degree + 19)) * unit));
  error += reach * (1 + result.depth_error) *
           (depth_units<Degree> * unit * (depth_sum + 2 * sum * depth_below) + position_sum * depth_from_x);
  if (associated) error += sums.transmitted * reach * slope * piece.x_error;
  error = piece.length * (error + power_of_2_above(log2_truncation));
  // An error of the depth above 1, a sum out of range: the integrals of tau T and T are at most 1 and length.
  const Vector crude =
      magnitude(result.weight_0) + magnitude(result.weight_1) + (associated ? one : piece.length) * reach;
  result.weight_error = slack * select(result.depth_error < Vector(most_error), error, crude);
  return result;
}

/// `first`, or as many steps more as reach `least`. Found by branches: a processor that foresees them takes up the
/// nodes without waiting for what says how many they are, which is a third of the time of a piece.
inline std::size_t foreseen_count(std::size_t first, std::size_t step, double least) {
  std::size_t count = first;
  while (static_cast<double>(count) < least) count += step;
  return count;
}

/// Pieces in lanes, or one piece in a double: node after node. `nodes` above most_nodes: not integrated.
template <int Degree, class Vector>
[[gnu::flatten]] PieceIntegral<Vector> integrate_node_by_node(const LinearPiece<Degree, Vector>& piece,
                                                              bool associated) {
  constexpr double too_many = most_nodes + 1;
  const auto prepared = prepare(piece);
  const Vector goal_here = log2_goal(piece, prepared, associated);
  const auto is_shallow = prepared.depth[Degree + 1] < Vector(deepest);
  const double depth = largest(select(is_shallow, prepared.depth[Degree + 1], Vector(0)));
  const Vector fewest = nodes_for(piece, prepared, associated, goal_here, ellipses<Degree>().at(depth));
  const Vector nodes = select(is_shallow, smaller<Vector>(fewest, too_many), Vector(too_many));
  // Pieces that are too deep are done again by the caller; they do not make the others pay.
  const double most = largest(select(nodes < Vector(too_many), nodes, Vector(1)));
  const std::size_t count = foreseen_count(4, 2, most);
  const auto& table = node_table<Degree>(count);

  Sums<Vector> sums;
  for (std::size_t i = 0; i < count; ++i) {
    Vector x{};
    Vector depth_here{};
    Vector extinction{};
    for (std::size_t j = 0; j <= Degree; ++j) {
      x = multiply_add(Vector(table.signal_basis[j][i]), piece.x[j], x);
      extinction = multiply_add(Vector(table.signal_basis[j][i]), prepared.extinction[j], extinction);
      depth_here = multiply_add(Vector(table.depth_basis[j + 1][i]), prepared.depth[j + 1], depth_here);
    }
    sums.add(associated, table.nodes[i], table.weights[i], x, extinction, depth_here);
  }
  const auto additions = static_cast<double>(count);
  auto result = finish(piece, prepared, associated, sums, additions, goal_here);
  result.nodes = select(nodes < Vector(too_many), Vector(additions), nodes);
  return result;
}

/// One piece, its nodes in lanes, which all are filled.
template <int Degree>
[[gnu::flatten]] PieceIntegral<> integrate_nodes_side_by_side(const LinearPiece<Degree>& piece, bool associated) {
  const auto prepared = prepare(piece);
  const double goal_here = log2_goal(piece, prepared, associated);
  const double depth = prepared.depth[Degree + 1];
  const double fewest = nodes_for(piece, prepared, associated, goal_here, ellipses<Degree>().at(depth));
  if (!(fewest <= most_nodes && depth < deepest)) return {.nodes = most_nodes + 1};
  const std::size_t nodes = foreseen_count(lane_count, lane_count, fewest);
  const auto& table = node_table<Degree>(nodes);

  Sums<Lanes> sums;
  for (std::size_t i = 0; i < nodes; i += lane_count) {
    Lanes x{};
    Lanes depth_here{};
    Lanes extinction{};
    for (std::size_t j = 0; j <= Degree; ++j) {
      const Lanes basis = Lanes::load(&table.signal_basis[j][i]);
      x = multiply_add(basis, Lanes(piece.x[j]), x);
      extinction = multiply_add(basis, Lanes(prepared.extinction[j]), extinction);
      depth_here = multiply_add(Lanes::load(&table.depth_basis[j + 1][i]), Lanes(prepared.depth[j + 1]), depth_here);
    }
    sums.add(associated, Lanes::load(&table.nodes[i]), Lanes::load(&table.weights[i]), x, extinction, depth_here);
  }
  constexpr std::size_t additions_of_lanes = 3;
  const std::size_t additions = nodes / lane_count + additions_of_lanes;
  auto result = finish<Degree, double>(
      piece, prepared, associated,
      {sum(sums.weight_0), sum(sums.weight_1), sum(sums.transmitted), sum(sums.depth), sum(sums.position)},
      static_cast<double>(additions), goal_here);
  result.nodes = static_cast<double>(nodes);
  return result;
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
