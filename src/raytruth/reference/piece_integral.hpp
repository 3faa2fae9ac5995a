#pragma once

#include "raytruth/kernels/linear_piece.hpp"
#include "raytruth/transfer/emission.hpp"

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

}  // namespace raytruth
