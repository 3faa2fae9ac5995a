#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/reference/arb/arb_numbers.hpp"
#include "raytruth/signals/analytic.hpp"
#include "raytruth/signals/marschner_lobb.hpp"

#include <vector>

namespace raytruth::arb {

/// A piece of a ray: a polynomial in x on [0, 1] that encloses the signal, t = start + length x.
struct BallPiece {
  Polynomial signal;
  std::vector<Ball> control;  ///< its Bernstein coefficients
  Ball length;
  Ball end = 1.0;  ///< where in x the next piece starts: 1, but for the rounding of a chain's lengths
};

/// The pieces of a signal in their order; see `arb_integral`.
template <int Degree>
std::vector<BallPiece> pieces_of(const Chain<Degree>& chain);
std::vector<BallPiece> pieces_of(const MarschnerLobbRay& signal);
std::vector<BallPiece> pieces_of(const AnalyticSignal& signal);

}  // namespace raytruth::arb
