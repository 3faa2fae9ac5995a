#pragma once

#include <vector>

namespace raytruth {

/// How far a chain may be from the signal that it stands for: the rounding of its making. The default: not at all.
struct SignalError {
  std::vector<double> of_pieces;      ///< |s(t) - chain(t)| on each piece; empty: zeros
  double of_length = 0;               ///< of the whole ray, in units of t
  double unclaimed = 0;               ///< t for which `of_pieces` says nothing, in all: ends of constant pieces
  std::vector<bool> exact_ends = {};  ///< whether a piece is exact at both ends; empty: only where its error is 0
};

}  // namespace raytruth
