#pragma once

#include "raytruth/tables/table.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

/// The deepest slab that is told exactly. Where the extinction rises from 0, all light of a slab of depth D comes from
/// the first 1 / sqrt(D) of it, and positions are known to 10^-14: depths up to there to 10^-14 sqrt(D), 10^-8 here.
inline constexpr double largest_exact_depth = 1e12;

/// Throws InputError for a transfer function and slabs that may be deeper.
void check_depth(const PiecewiseLinear& transfer, const TableAxes& axes);

/// The continuous integral, the yardstick of all other tables: the slab between two neighbouring entries is exact
/// (interval_slabs.hpp), and subranges composite it (Lum 2004, section 4.2), which is exact too. A test certifies 10^4
/// entries, one by one, by the reference. Throws InputError as `check` and as `check_depth` do.
Table<double> exact_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission);

}  // namespace raytruth
