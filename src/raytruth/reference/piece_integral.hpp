#pragma once

#include "raytruth/kernels/linear_piece.hpp"
#include "raytruth/kernels/opacity_piece.hpp"
#include "raytruth/transfer/emission.hpp"

#include <utility>

namespace raytruth {

/// exp(-92) < 2^-132: what lies behind so much is bounded, not computed.
inline constexpr double opaque_depth = 92;

/// One piece of any depth, certified; its quadrature's nodes side by side.
template <int Degree>
PieceIntegral<> integrate(const LinearPiece<Degree>& piece, Emission emission);

/// One piece of any depth, certified; one node after the other.
template <int Degree>
PieceIntegral<> integrate_scalar(const LinearPiece<Degree>& piece, Emission emission);

/// Eight pieces side by side.
template <int Degree>
PieceIntegral<Eight> integrate(const LinearPiece<Degree, Eight>& pieces, Emission emission);

/// One piece on which the opacity is linear, certified, wherever it reaches 1. Where it stays so near to 1 that
/// rounding hides how near, the depth is enclosed: a polynomial of degree n is not small for long, the mean of ln |p|
/// over a stretch is at least ln(max |p|) - 1.2785 n. (It is enough that this holds for n = 1. The distance of u from a
/// real r, relative to its largest, is smallest for r in the stretch; there the mean of ln |u - r| over [0, 1] is r
/// ln(r) + (1 - r) ln(1 - r) - 1, the largest ln(1 - r) for r <= 1/2, and their difference, -1 - r ln((1 - r) / r), is
/// least at r = 0.2178.) A piece that is opaque throughout gets `beyond_opaque` for its depth, and the colour at its
/// front.
template <int Degree>
PieceIntegral<> integrate(const OpacityPiece<Degree>& piece, Emission emission);

/// Eight of them side by side.
template <int Degree>
PieceIntegral<Eight> integrate(const OpacityPiece<Degree, Eight>& pieces, Emission emission);

/// What is known of a piece without any quadrature: the smallest and largest depth, or all but nothing.
template <int Degree>
PieceIntegral<> crude(const OpacityPiece<Degree>& piece, Emission emission);

/// The two halves of a piece.
template <int Degree>
std::pair<OpacityPiece<Degree>, OpacityPiece<Degree>> halves(const OpacityPiece<Degree>& piece);

/// Whether halves of a piece, of this many halvings, would tell no more: it is hidden by rounding, or short enough.
template <int Degree>
bool is_undividable(const OpacityPiece<Degree>& piece, int level);

/// The optical depth that stands for an infinite one: exponentials of less than -700 count as that of -700.
inline constexpr double beyond_opaque = 1000;

}  // namespace raytruth
