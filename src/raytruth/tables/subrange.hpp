#pragma once

#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/subranges.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table_cost.hpp"

#include <algorithm>

namespace raytruth {

/// A table off its diagonal, of slabs one behind another: make(width, backwards) as `for_each_entry` asks for.
template <class Real, class Make>
void composite_subranges(Table<Real>& table, const Make& make) {
  using Slab = typename Rules<Real>::vec4;
  for_each_entry(
      table.axes.size, make,
      [](const Slab& front, const Slab& back) -> Slab { return Rules<Real>{}.over(front, back); },
      [&table](std::size_t front, std::size_t back, const Slab& slab) { table.set(front, back, slab); });
}

/// Lum 2004, section 4.2: incremental subrange integration. It gives the numbers of `brute_force_table`, in O(n^2).
template <class Real>
Table<Real> subrange_table(const DiscreteTransfer& transfer, const TableAxes& axes) {
  Table<Real> table(axes);
  const auto stretch = [&](double length) {
    return [&transfer, length](const Optics& optics) {
      return homogeneous_stretch<Real>(optics, transfer.emission, length);
    };
  };
  composite_subranges(table, [&](std::size_t width, bool backwards) {
    return elements_of(transfer.intervals, backwards, stretch(axes.length / static_cast<double>(width)));
  });
  for (std::size_t i = 0; i < axes.size; ++i) table.set(i, i, stretch(axes.length)(transfer.entries[i]));
  return table;
}

/// Lum 2004, section 4.3 as printed: from i to j inclusive, |j - i| + 1 entries of the length Delta / |j - i| each (eq.
/// 1), so that slabs are too long by one entry; the limit for i = j is the same.
Table<double> inclusive_subrange_table(const DiscreteTransfer& transfer, const TableAxes& axes);

/// For every width w and n - 1 intervals: 2 (n - 1) exponentials; composites of the bins' suffixes, of the prefixes,
/// and of both. Below 6 n^2 composites.
inline TableCost subrange_cost(std::int64_t size) {
  TableCost cost{.composites = 0, .exponentials = 2 * (size - 1) * (size - 1) + size};
  for (std::int64_t width = 1; width < size; ++width)
    for (std::int64_t bin = 0; bin + width < size; bin += width) {
      const std::int64_t shared = std::min(width - 1, size - 1 - bin - width);
      cost.composites += 2 * (width - 1 + shared + std::max<std::int64_t>(shared - 1, 0));
    }
  return cost;
}

}  // namespace raytruth
