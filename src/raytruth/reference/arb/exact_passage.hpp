#pragma once

#include "raytruth/core/double_double.hpp"
#include "raytruth/signals/precise_chain.hpp"

#include <cstddef>
#include <vector>

namespace raytruth::arb {

/// Where the scalar of a piece passes one of several scalars.
struct ExactCrossing {
  DoubleDouble place;      ///< in the piece's unit coordinate, to 2^-104
  std::size_t scalar = 0;  ///< which one
  bool is_rising = false;
};

/// What a piece's scalar does, seen from several scalars.
struct ExactPassage {
  std::vector<int> first_signs;  ///< of the piece's scalar less each of them, just behind the piece's beginning; 0:
                                 ///< they are one and the same throughout
  std::vector<ExactCrossing> crossings;  ///< in order, strictly inside of the piece
};

/// All crossings of a piece whose coefficients are known exactly (`powers`, or `polynomial` if `error` is 0), decided
/// without rounding: a zero of even order is none, however near two zeros are they stand in their order, and one that
/// lies on an end of the piece is not inside.
template <int Degree>
ExactPassage exact_passage(const PrecisePiece<Degree>& piece, const std::vector<double>& scalars);

}  // namespace raytruth::arb
