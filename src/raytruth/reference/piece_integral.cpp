#include "raytruth/reference/piece_integral.hpp"

#include "raytruth/kernels/depth_table.hpp"
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

/// Depths fall below any limit in 1200 halvings; what resists for other reasons is given up much earlier.
constexpr int most_levels = 1200;

template <int Degree>
bool is_given_up(const LinearPiece<Degree>& /*piece*/, const PieceIntegral<>& bound, int level) {
  constexpr int most_levels_of_shallow = 20;
  return level == most_levels || (bound.depth < 1 && level >= most_levels_of_shallow);
}

template <int Degree>
bool is_given_up(const OpacityPiece<Degree>& piece, const PieceIntegral<>& bound, int level) {
  // A shallow piece on which 1 - a hardly varies needs few halves, if its degree is high; or its numbers are out of
  // range.
  constexpr int most_levels_of_plain = 10;
  const auto [least, most] = std::minmax_element(piece.clear.begin(), piece.clear.end());
  return is_undividable(piece, level) ||
         (level >= most_levels_of_plain && bound.depth + bound.depth_error < 1 && *most < 1.25 * *least);
}

/// What is known of an opacity piece without any quadrature.
template <int Degree>
PieceIntegral<> crude(const OpacityPiece<Degree>& piece, bool associated) {
  const auto [least_x, most_x] = std::minmax_element(piece.x.begin(), piece.x.end());
  const double reach = std::max(*most_x, 1 - *least_x);
  const double x = *least_x + (*most_x - *least_x) / 2;
  const double span = (*most_x - *least_x) / 2 + 4 * unit_roundoff * reach + piece.x_error;
  double most_clear = 0;
  for (const double b : piece.clear) most_clear = std::max(most_clear, std::abs(b));
  const double noise = piece.clear_error + 8 * unit_roundoff * most_clear;
  if (most_clear == 0 && noise == 0)
    return {.weight_0 = associated ? 1 - piece.x[0] : 0,
            .weight_1 = associated ? piece.x[0] : 0,
            .weight_error = slack * (piece.x_error + 4 * unit_roundoff * reach),
            .depth = beyond_opaque};

  const double known = std::max(std::abs(piece.clear.front()), std::abs(piece.clear.back())) - noise;
  const double least_depth =
      most_clear + noise < 1 ? piece.units * std::max(0.0, -std::log(most_clear + noise)) / slack : 0;
  const double most_depth =
      known > 0 ? slack * piece.units * (std::max(0.0, -std::log(known)) + 1.2785 * Degree) : HUGE_VAL;
  const double least_opacity = -std::expm1(-least_depth);
  const double opacity_error = slack * (-std::expm1(-most_depth) - least_opacity) / 2;
  const double opacity = least_opacity + opacity_error;
  PieceIntegral<> result{.depth = std::isfinite(most_depth) ? (least_depth + most_depth) / 2 : least_depth,
                         .depth_error = slack * (most_depth - least_depth)};
  const double most_emitted = associated ? 1 : piece.length;
  const double emitted = associated ? opacity : piece.length * (1 - opacity / 2);
  const double emitted_error =
      associated ? opacity_error : piece.length * (opacity / 2 + opacity_error + 8 * unit_roundoff);
  result.weight_0 = (1 - x) * emitted;
  result.weight_1 = x * emitted;
  result.weight_error = slack * (span * most_emitted + reach * (emitted_error + 8 * unit_roundoff * emitted));
  return result;
}

template <int Degree>
constexpr double most_nodes_of(const LinearPiece<Degree>& /*piece*/) {
  return most_nodes;
}
template <int Degree>
constexpr double most_nodes_of(const OpacityPiece<Degree>& /*piece*/) {
  return most_points;
}

/// Nor is what lies behind an unknown depth computed: either half of a piece might be so deep, at every level.
bool is_behind_seen(const PieceIntegral<>& front) {
  return front.depth - front.depth_error <= opaque_depth && front.depth_error <= opaque_depth;
}

/// Two pieces, one behind the other.
PieceIntegral<> composed(const PieceIntegral<>& front, const PieceIntegral<>& behind) {
  PieceIntegral<> result = front;
  const double front_depth = front.depth - front.depth_error;
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

template <class Piece, class Whole>
PieceIntegral<> integrate_by_halves(const Piece& piece, bool associated, const Whole& whole, int level);

/// `whole` integrates a piece in one go, or says that it cannot; then its halves.
template <class Piece, class Whole>
PieceIntegral<> integrate(const Piece& piece, bool associated, const Whole& whole, int level = 0) {
  PieceIntegral<> result = whole(piece, associated);
  if (!(result.nodes <= most_nodes_of(piece))) result = integrate_by_halves(piece, associated, whole, level);
  return result;
}

template <class Piece, class Whole>
PieceIntegral<> integrate_by_halves(const Piece& piece, bool associated, const Whole& whole, int level) {
  const PieceIntegral<> bound = crude(piece, associated);
  if (is_given_up(piece, bound, level)) return bound;
  const auto [front, back] = halves(piece);
  const PieceIntegral<> result = integrate(front, associated, whole, level + 1);
  return composed(result,
                  is_behind_seen(result) ? integrate(back, associated, whole, level + 1) : crude(back, associated));
}

/// The piece between two places of its unit coordinate.
template <int Degree>
LinearPiece<Degree> part_of(const LinearPiece<Degree>& piece, double begin, double end) {
  LinearPiece<Degree> part = piece;
  part.x = Bernstein<Degree>{piece.x}.restricted(begin, end).coefficients;
  double reach = 0;
  for (const double x : piece.x) reach = std::max(reach, std::abs(x));
  part.length = (end - begin) * piece.length;
  part.x_error += slack * 4 * Degree * unit_roundoff * reach;
  return part;
}

/// A piece that may be so deep that halving it down to what is seen would add up to many errors: it is cut at powers of
/// two, each part from the whole.
template <int Degree, class Whole>
PieceIntegral<> integrate_bottomless(const LinearPiece<Degree>& piece, double most_depth, bool associated,
                                     const Whole& whole) {
  constexpr int first_depth = 10;  // of the part at the front, by its exponent
  const int octaves = std::ilogb(most_depth) - first_depth;
  PieceIntegral<> result;
  for (int octave = octaves; octave >= 0; --octave) {
    const double begin = octave == octaves ? 0 : std::ldexp(1, -octave - 1);
    const double end = std::ldexp(1, -octave);
    result = composed(result, integrate(part_of(piece, begin, end), associated, whole));
    if (is_behind_seen(result)) continue;
    return end < 1 ? composed(result, crude(part_of(piece, end, 1), associated)) : result;
  }
  return result;
}

/// An upper bound for the optical depth.
template <int Degree>
double most_depth(const LinearPiece<Degree>& piece) {
  double reach = 0;
  for (const double x : piece.x) reach = std::max({reach, std::abs(x), std::abs(1 - x)});
  return piece.length * (piece.extinction_at_0 + piece.extinction_at_1) * reach;
}

/// A piece of any depth.
template <int Degree, class Whole>
PieceIntegral<> integrate_whole(const LinearPiece<Degree>& piece, bool associated, const Whole& whole) {
  constexpr double bottomless = 0x1p20;
  const double most = most_depth(piece);
  return most > bottomless && std::isfinite(most) ? integrate_bottomless(piece, most, associated, whole)
                                                  : integrate(piece, associated, whole);
}

}  // namespace

template <int Degree>
std::pair<OpacityPiece<Degree>, OpacityPiece<Degree>> halves(const OpacityPiece<Degree>& piece) {
  std::pair<OpacityPiece<Degree>, OpacityPiece<Degree>> result{piece, piece};
  auto& [front, back] = result;
  const auto halve = [](auto& first, auto& second) {
    double largest = 0;
    for (std::size_t last = Degree; last > 0; --last) {
      first[Degree - last] = second[0];
      for (std::size_t i = 0; i < last; ++i) second[i] = 0.5 * (second[i] + second[i + 1]);
    }
    first[Degree] = second[0];
    for (const auto* half : {&first, &second})
      for (const double b : *half) largest = std::max(largest, std::abs(b));
    return slack * Degree * unit_roundoff * largest;
  };
  const double x_rounding = halve(front.x, back.x);
  halve(front.opacity, back.opacity);
  halve(front.clear, back.clear);
  front.length = back.length = 0.5 * piece.length;
  front.units = back.units = 0.5 * piece.units;
  front.x_error = back.x_error = piece.x_error + x_rounding;
  // Halving sums of positive terms errs by units of the half's own size; a and 1 - a go their own ways.
  for (OpacityPiece<Degree>* half : {&front, &back}) {
    double largest_clear = 0;
    double largest_opacity = 0;
    for (const double b : half->clear) largest_clear = std::max(largest_clear, std::abs(b));
    for (const double a : half->opacity) largest_opacity = std::max(largest_opacity, std::abs(a));
    half->clear_error =
        piece.clear_error + slack * Degree * unit_roundoff * std::min(largest_clear, 4 * largest_opacity);
  }
  return result;
}

template <int Degree>
PieceIntegral<> crude(const OpacityPiece<Degree>& piece, Emission emission) {
  return crude(piece, emission == Emission::associated);
}

template <int Degree>
bool is_undividable(const OpacityPiece<Degree>& piece, int level) {
  // So many halvings leave 2^-54 of a piece; deep ones are halved for another reason.
  constexpr int most_levels_for_contacts = 54;
  double most_clear = 0;
  for (const double b : piece.clear) most_clear = std::max(most_clear, std::abs(b));
  const int levels_for_depth = std::max(0, std::ilogb(std::max(piece.units, 1.0)));
  return level >= most_levels || most_clear <= 8 * piece.clear_error ||
         level >= most_levels_for_contacts + levels_for_depth;
}

template <int Degree>
PieceIntegral<> integrate(const OpacityPiece<Degree>& piece, Emission emission) {
  return integrate(piece, emission == Emission::associated, kernels<Degree>().integrate_one_opacity);
}

template <int Degree>
PieceIntegral<Eight> integrate(const OpacityPiece<Degree, Eight>& pieces, Emission emission) {
  PieceIntegral<Eight> result = kernels<Degree>().integrate_eight_opacities(pieces, emission == Emission::associated);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (result.nodes[lane] <= most_points) continue;
    OpacityPiece<Degree> piece{.x_error = pieces.x_error[lane],
                               .clear_error = pieces.clear_error[lane],
                               .length = pieces.length[lane],
                               .units = pieces.units[lane]};
    for (std::size_t j = 0; j <= Degree; ++j) {
      piece.x[j] = pieces.x[j][lane];
      piece.opacity[j] = pieces.opacity[j][lane];
      piece.clear[j] = pieces.clear[j][lane];
    }
    set_lane(result, lane, integrate(piece, emission));
  }
  return result;
}

template <int Degree>
PieceIntegral<> integrate(const LinearPiece<Degree>& piece, Emission emission) {
  return integrate_whole(piece, emission == Emission::associated, kernels<Degree>().integrate_one);
}

template <int Degree>
PieceIntegral<> integrate_scalar(const LinearPiece<Degree>& piece, Emission emission) {
  return integrate_whole(piece, emission == Emission::associated, kernels<Degree>().integrate_scalar);
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
    set_lane(result, lane, integrate(piece, emission));
  }
  return result;
}

template PieceIntegral<> integrate(const LinearPiece<3>&, Emission);
template PieceIntegral<> integrate(const LinearPiece<largest_degree>&, Emission);
template PieceIntegral<> integrate_scalar(const LinearPiece<3>&, Emission);
template PieceIntegral<> integrate_scalar(const LinearPiece<largest_degree>&, Emission);
template PieceIntegral<Eight> integrate(const LinearPiece<3, Eight>&, Emission);
template PieceIntegral<Eight> integrate(const LinearPiece<largest_degree, Eight>&, Emission);

template PieceIntegral<> integrate(const OpacityPiece<3>&, Emission);
template PieceIntegral<> integrate(const OpacityPiece<largest_degree>&, Emission);
template PieceIntegral<Eight> integrate(const OpacityPiece<3, Eight>&, Emission);
template PieceIntegral<Eight> integrate(const OpacityPiece<largest_degree, Eight>&, Emission);
template std::pair<OpacityPiece<3>, OpacityPiece<3>> halves(const OpacityPiece<3>&);
template std::pair<OpacityPiece<largest_degree>, OpacityPiece<largest_degree>> halves(
    const OpacityPiece<largest_degree>&);
template PieceIntegral<> crude(const OpacityPiece<3>&, Emission);
template PieceIntegral<> crude(const OpacityPiece<largest_degree>&, Emission);
template bool is_undividable(const OpacityPiece<3>&, int);
template bool is_undividable(const OpacityPiece<largest_degree>&, int);

}  // namespace raytruth
