#pragma once

#include "raytruth/core/slab.hpp"
#include "raytruth/reference/certified.hpp"

#include <cstdint>
#include <string_view>

namespace raytruth {

/// How many voxels a trilinear sample of the signal reads.
inline constexpr std::int64_t voxels_per_fetch = 8;

/// What a scheme makes of a ray, and what it reads and does for it.
template <class Real = double>
struct Outcome : Slab<Real> {
  double radius = 0;            ///< of an exact integral: how far it may be from what the scheme defines; else 0
  std::int64_t fetches = 0;     ///< samples of the signal, those between the given ones included
  std::int64_t voxels = 0;      ///< that the fetches read; of cell_cubic eight per cell, each a fetch of its own
  std::int64_t lookups = 0;     ///< of the transfer function, or of a table
  std::int64_t composites = 0;  ///< slabs put together
  Status status = Status::converged;
  std::string_view refusal;  ///< why the scheme cannot use these samples; empty: it can
};

}  // namespace raytruth
