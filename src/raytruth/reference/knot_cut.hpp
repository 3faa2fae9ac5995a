#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/reference/linear_interval.hpp"

#include <cstddef>
#include <vector>

namespace raytruth {

/// Part of a polynomial piece on which the scalar stays in one interval of a transfer function, or nearly.
struct KnotStretch {
  std::size_t piece;
  double begin;  ///< in the piece's unit coordinate
  double end;
  std::size_t interval;
};

/// Cuts polynomial pieces where the scalar crosses the points of a transfer function. Crossings are good guesses
/// (`Kernels::crossings`). Holds buffers: one object per thread.
class KnotCut {
 public:
  /// Appends the stretches of one piece, front to back. Degree 3 or 9.
  template <int Degree>
  void operator()(const LinearIntervals& intervals, const Bernstein<Degree>& polynomial, std::size_t piece,
                  std::vector<KnotStretch>& stretches);

 private:
  std::vector<double> targets_;
  std::vector<double> abscissae_;
};

}  // namespace raytruth
