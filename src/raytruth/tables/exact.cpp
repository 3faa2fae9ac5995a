#include "raytruth/tables/exact.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/interval_slabs.hpp"
#include "raytruth/tables/subrange.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace raytruth {

void check_depth(const PiecewiseLinear& transfer, const TableAxes& axes) {
  // Where the opacity is linear the depth is finite and told by its logarithm, or infinite and all light comes from the
  // front.
  if (transfer.is_linear_in_opacity()) return;
  double largest = 0;
  for (const TransferPoint& point : transfer.points()) largest = std::max(largest, point.optics.extinction);
  if (largest * axes.length > largest_exact_depth)
    throw InputError(fmt::format("found slabs of length {}, of an optical depth of up to {}; at most {} is allowed",
                                 axes.length, largest * axes.length, largest_exact_depth));
}

Table<double> exact_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission) {
  Table<double> table(axes);
  check_depth(transfer, axes);
  const IntervalSlabs slabs(transfer, axes, emission);
  composite_subranges(table, [&](std::size_t width, bool backwards) {
    return slabs(axes.length / static_cast<double>(width), backwards);
  });
  for (std::size_t i = 0; i < axes.size; ++i)
    table.set(i, i, homogeneous_stretch<double>(transfer.at(axes.scalar(i)), emission, axes.length));
  return table;
}

}  // namespace raytruth
