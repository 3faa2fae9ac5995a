#pragma once

#include "raytruth/core/double_double.hpp"
#include "raytruth/signals/precise_chain.hpp"

#include <cstddef>
#include <vector>

namespace raytruth {

/// A crossing of an isosurface. A surface is crossed where the scalar is on different sides of it on two neighbouring
/// stretches of the ray: in a zero of odd order, in a kink, in a jump, or where a stretch on the surface begins. Where
/// the scalar touches a surface from one side, and at the ends of the ray, nothing is crossed.
struct SurfaceHit {
  DoubleDouble t;           ///< lengths as the chain has them
  double error = 0;         ///< bounds how far t may be off
  std::size_t surface = 0;  ///< which one
  bool is_rising = false;   ///< whether the scalar comes from below
  // Where that is in the chain:
  std::size_t piece = 0;
  DoubleDouble u = {};  ///< in the piece's unit coordinate
};

/// Part of a ray on which it is not known how often the scalar crosses a surface: it is nearer to it than what is known
/// of the signal. If the scalar is on different sides before and behind it, a hit stands there too.
struct UnresolvedContact {
  double from = 0;
  double to = 0;
  std::size_t surface = 0;
};

/// What is known of a signal where its constant pieces may end a moment earlier or later than they do.
struct Surroundings {
  double steepest = 0;  ///< bounds how fast the scalar can vary at all
  /// Whether that moment is the neighbouring piece's for certain: along an axis of a volume. Else a ray may pass a
  /// corner of a third cell, of which no piece tells.
  bool are_in_line = false;
};

struct SurfaceHits {
  std::vector<SurfaceHit> hits;               ///< in the order in which a ray meets them
  std::vector<UnresolvedContact> unresolved;  ///< ascending
};

/// All crossings of a signal with the surfaces at these scalars, ascending ones. A signal whose coefficients are known
/// exactly leaves nothing unresolved: what 106 bits cannot tell is decided in rational numbers. Of others, as rays
/// through a volume, what they are off by is in the errors of t.
///
/// `surroundings`: of a signal that has some length unclaimed.
template <int Degree>
SurfaceHits surface_hits(const PreciseChain<Degree>& signal, const std::vector<double>& scalars,
                         const Surroundings& surroundings = {});

}  // namespace raytruth
