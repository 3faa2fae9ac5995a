#pragma once

#include "reference/certified.hpp"
#include "tables/table.hpp"
#include "transfer/piecewise_linear.hpp"

namespace raytruth {

/// The continuous integral, the yardstick of all other tables: the slab between two neighbouring entries is exact
/// (interval_slabs.hpp), and subranges composite it (Lum 2004, section 4.2), which is exact too. A test certifies 10^4
/// entries, one by one, by the reference. Throws InputError as `check` does.
Table<double> exact_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission);

}  // namespace raytruth
