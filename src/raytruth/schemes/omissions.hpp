#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

namespace raytruth {

/// A part of a ray, from `begin` to `end`.
struct RayPart {
  double begin;
  double end;
};

/// What a renderer leaves out of a ray to save time.
struct Omissions {
  /// Slabs that touch none of these parts, which are in order and disjoint, are taken for empty; none: no slab is.
  std::optional<std::span<const RayPart>> occupied = {};
  /// The ray ends behind the slab with which its opacity reaches this.
  double opaque = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool are_none() const { return !occupied && opaque == std::numeric_limits<double>::infinity(); }

  /// Whether the slab from `begin` to `end` is left out.
  [[nodiscard]] bool omit(double begin, double end) const {
    if (!occupied) return false;
    const auto next = std::lower_bound(occupied->begin(), occupied->end(), begin,
                                       [](const RayPart& part, double t) { return part.end <= t; });
    return next == occupied->end() || end <= next->begin;
  }
};

}  // namespace raytruth
