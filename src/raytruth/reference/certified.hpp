#pragma once

#include "raytruth/core/slab.hpp"

#include <cstdint>

namespace raytruth {

/// Whether a certified value is as close as was asked for. Its radius holds in either case.
enum class Status { converged, not_converged };

/// The volume rendering integral with a proven bound: every channel of the exact colour and the exact opacity lie
/// within `radius` of the values here.
struct Certified : Slab<> {
  double radius = 0;
  std::int64_t evaluations = 0;  ///< of the integrand
  Status status = Status::converged;
};

}  // namespace raytruth
