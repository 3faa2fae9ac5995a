#pragma once

#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table_cost.hpp"

#include <tbb/parallel_for.h>

namespace raytruth {

/// Lum 2004, section 4.1: every entry by itself, from front to back, |j - i| intervals of the length Delta / |j - i|
/// each, one opacity correction per composite; O(n^3). With tau = -ln(1 - alpha) eq. 1 is
///
///     1 - (1 - alpha)^(Delta / |j - i|) = 1 - exp(-tau Delta / |j - i|),
///
/// and its limit for i = j the homogeneous slab of entry i. `transfer` has as many entries as the table.
template <class Real>
Table<Real> brute_force_table(const DiscreteTransfer& transfer, const TableAxes& axes) {
  Table<Real> table(axes);
  tbb::parallel_for(std::size_t{0}, axes.size, [&](std::size_t back) {
    for (std::size_t front = 0; front < axes.size; ++front) {
      if (front == back) {
        table.set(front, front, homogeneous_stretch<Real>(transfer.entries[front], transfer.emission, axes.length));
        continue;
      }
      const bool ascends = front < back;
      const std::size_t width = ascends ? back - front : front - back;
      const Real length(axes.length / static_cast<double>(width));
      const auto interval = [&](std::size_t k) {
        return homogeneous_stretch<Real>(transfer.intervals[ascends ? front + k : front - 1 - k], transfer.emission,
                                         length);
      };
      typename Rules<Real>::vec4 slab = interval(0);
      for (std::size_t k = 1; k < width; ++k) slab = Rules<Real>{}.over(slab, interval(k));
      table.set(front, back, slab);
    }
  });
  return table;
}

/// sum over i != j of |j - i| - 1 composites, and of |j - i| exponentials; one more for each i = j.
inline TableCost brute_force_cost(std::int64_t size) {
  const std::int64_t intervals = (size - 1) * size * (size + 1) / 3;
  return {.composites = intervals - size * (size - 1), .exponentials = intervals + size};
}

}  // namespace raytruth
