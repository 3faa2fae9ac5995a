#pragma once

#include "core/vector3.hpp"

#include <cstdint>
#include <vector>

namespace raytruth {

/// What a transfer function's colour c(s) means: how much light a unit of length sends out.
enum class Emission {
  associated,  ///< q = tau(s) c(s): the medium glows as much as it absorbs (El Hajjar 2008, eq. 1)
  plain,       ///< q = c(s) (Guetat 2010, eq. 3)
};

/// Whether a certified value is as close as was asked for. Its radius holds in either case.
enum class Status { converged, not_converged };

/// The volume rendering integral with a proven bound: every channel of the exact colour and the exact opacity lie
/// within `radius` of the values here.
struct Certified {
  Vector3<double> color = Vector3<double>::Constant(0);
  double opacity = 0;
  double radius = 0;
  std::int64_t evaluations = 0;  ///< of the integrand
  Status status = Status::converged;
};

/// How far a chain may be from the signal that it stands for: the rounding of its making. The default: not at all.
struct SignalError {
  std::vector<double> of_pieces;  ///< |s(t) - chain(t)| on each piece; empty: zeros
  double of_length = 0;           ///< of the whole ray, in units of t
  double unclaimed = 0;           ///< t for which `of_pieces` says nothing, in all: ends of constant pieces
};

}  // namespace raytruth
