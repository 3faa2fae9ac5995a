#include "raytruth/reference/piece_integral.hpp"

#include "raytruth/kernels/exponential.hpp"
#include "raytruth/kernels/gauss_legendre.hpp"
#include "raytruth/kernels/kernels.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace raytruth {

namespace {

constexpr double slack = 1 + 0x1p-20;  // second-order terms, and the rounding of the error bounds themselves

/// Nothing but its size: x and 1 - x times the integral of tau T, which is at most 1, or of T, at most the length.
template <int Degree>
PieceIntegral<> crude(const LinearPiece<Degree>& piece, bool associated) {
  double reach = 0;
  double depth = 0;
  double most_depth = 0;
  for (const double x : piece.x) {
    const double y = 1 - x;
    reach = std::max({reach, std::abs(x), std::abs(y)});
    depth += piece.length / (Degree + 1) * (piece.extinction_at_0 * y + piece.extinction_at_1 * x);
    most_depth +=
        piece.length / (Degree + 1) * (piece.extinction_at_0 * std::abs(y) + piece.extinction_at_1 * std::abs(x));
  }
  return {
      .weight_error = slack * reach * (associated ? 1 : piece.length),
      .depth = depth,
      .depth_error = slack * ((2 * Degree + 15) * unit_roundoff * most_depth +
                              piece.length * std::abs(piece.extinction_at_1 - piece.extinction_at_0) * piece.x_error)};
}

template <int Degree>
std::pair<LinearPiece<Degree>, LinearPiece<Degree>> halves(const LinearPiece<Degree>& piece) {
  std::pair<LinearPiece<Degree>, LinearPiece<Degree>> result{piece, piece};
  auto& [front, back] = result;
  double reach = 0;
  for (const double x : piece.x) reach = std::max(reach, std::abs(x));
  for (std::size_t last = Degree; last > 0; --last) {
    front.x[Degree - last] = back.x[0];
    for (std::size_t i = 0; i < last; ++i) back.x[i] = 0.5 * (back.x[i] + back.x[i + 1]);
  }
  front.x[Degree] = back.x[0];
  front.length = back.length = 0.5 * piece.length;
  front.x_error = back.x_error = piece.x_error + slack * Degree * unit_roundoff * reach;
  return result;
}

template <int Degree, class Whole>
PieceIntegral<> integrate_by_halves(const LinearPiece<Degree>& piece, bool associated, const Whole& whole, int level);

/// `whole` integrates a piece in one go, or says that it cannot; then its halves.
template <int Degree, class Whole>
PieceIntegral<> integrate(const LinearPiece<Degree>& piece, bool associated, const Whole& whole, int level = 0) {
  PieceIntegral<> result = whole(piece, associated);
  if (!(result.nodes <= most_nodes)) result = integrate_by_halves(piece, associated, whole, level);
  return result;
}

template <int Degree, class Whole>
PieceIntegral<> integrate_by_halves(const LinearPiece<Degree>& piece, bool associated, const Whole& whole, int level) {
  // Depths fall below any limit in 1200 halvings; what resists for other reasons is given up much earlier.
  constexpr int most_levels = 1200;
  constexpr int most_levels_of_shallow = 20;
  const PieceIntegral<> bound = crude(piece, associated);
  if (level == most_levels || (bound.depth < 1 && level >= most_levels_of_shallow)) return bound;
  const auto [front, back] = halves(piece);
  PieceIntegral<> result = integrate(front, associated, whole, level + 1);
  const double front_depth = result.depth - result.depth_error;
  // Nor is what lies behind an unknown depth computed: either half might be so deep, at every level.
  const bool is_behind_seen = front_depth <= opaque_depth && result.depth_error <= opaque_depth;
  const PieceIntegral<> behind =
      is_behind_seen ? integrate(back, associated, whole, level + 1) : crude(back, associated);
  const double transmittance = exponential(-result.depth);
  const double most_transmittance = slack * exponential(-std::max(front_depth, 0.0));
  result.weight_0 += transmittance * behind.weight_0;
  result.weight_1 += transmittance * behind.weight_1;
  result.weight_error = slack * (result.weight_error + most_transmittance * behind.weight_error +
                                 (std::abs(behind.weight_0) + std::abs(behind.weight_1)) * most_transmittance *
                                     (std::min(1.0, 2 * result.depth_error) + 8 * unit_roundoff) +
                                 4 * unit_roundoff * (std::abs(result.weight_0) + std::abs(result.weight_1)));
  result.depth += behind.depth;
  result.depth_error = slack * (result.depth_error + behind.depth_error + unit_roundoff * result.depth);
  result.nodes += behind.nodes;
  return result;
}

}  // namespace

template <int Degree>
PieceIntegral<> integrate(const LinearPiece<Degree>& piece, Emission emission) {
  return integrate(piece, emission == Emission::associated, kernels<Degree>().integrate_one);
}

template <int Degree>
PieceIntegral<> integrate_scalar(const LinearPiece<Degree>& piece, Emission emission) {
  return integrate(piece, emission == Emission::associated, kernels<Degree>().integrate_scalar);
}

template <int Degree>
PieceIntegral<Eight> integrate(const LinearPiece<Degree, Eight>& pieces, Emission emission) {
  PieceIntegral<Eight> result = kernels<Degree>().integrate_eight(pieces, emission == Emission::associated);
  bool are_all_done = true;  // asked of all at once, which is one branch, not eight
  for (const double nodes : result.nodes) are_all_done &= nodes <= most_nodes;
  if (are_all_done) return result;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (result.nodes[lane] <= most_nodes) continue;
    LinearPiece<Degree> piece{.x_error = pieces.x_error[lane],
                              .extinction_at_0 = pieces.extinction_at_0[lane],
                              .extinction_at_1 = pieces.extinction_at_1[lane],
                              .length = pieces.length[lane]};
    for (std::size_t j = 0; j <= Degree; ++j) piece.x[j] = pieces.x[j][lane];
    const PieceIntegral<> again = integrate(piece, emission);
    result.weight_0[lane] = again.weight_0;
    result.weight_1[lane] = again.weight_1;
    result.weight_error[lane] = again.weight_error;
    result.depth[lane] = again.depth;
    result.depth_error[lane] = again.depth_error;
    result.nodes[lane] = again.nodes;
  }
  return result;
}

template PieceIntegral<> integrate(const LinearPiece<3>&, Emission);
template PieceIntegral<> integrate(const LinearPiece<largest_degree>&, Emission);
template PieceIntegral<> integrate_scalar(const LinearPiece<3>&, Emission);
template PieceIntegral<> integrate_scalar(const LinearPiece<largest_degree>&, Emission);
template PieceIntegral<Eight> integrate(const LinearPiece<3, Eight>&, Emission);
template PieceIntegral<Eight> integrate(const LinearPiece<largest_degree, Eight>&, Emission);

}  // namespace raytruth
