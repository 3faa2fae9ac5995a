#include "tables/exact.hpp"

#include "tables/discrete_transfer.hpp"
#include "tables/interval_slabs.hpp"
#include "tables/subrange.hpp"

namespace raytruth {

Table<double> exact_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission) {
  Table<double> table(axes);
  const IntervalSlabs slabs(transfer, axes, emission);
  composite_subranges(table, [&](std::size_t width, bool backwards) {
    return slabs(axes.length / static_cast<double>(width), backwards);
  });
  for (std::size_t i = 0; i < axes.size; ++i)
    table.set(i, i, homogeneous_stretch<double>(transfer.at(axes.scalar(i)), emission, axes.length));
  return table;
}

}  // namespace raytruth
