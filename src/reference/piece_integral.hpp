#pragma once

#include "kernels/linear_piece.hpp"
#include "reference/certified.hpp"

namespace raytruth {

/// One piece of any depth, certified; its quadrature's nodes side by side.
template <int Degree>
PieceIntegral<> integrate(const LinearPiece<Degree>& piece, Emission emission);

/// The same, one node after the other.
template <int Degree>
PieceIntegral<> integrate_scalar(const LinearPiece<Degree>& piece, Emission emission);

/// Eight pieces side by side.
template <int Degree>
PieceIntegral<Eight> integrate(const LinearPiece<Degree, Eight>& pieces, Emission emission);

}  // namespace raytruth
