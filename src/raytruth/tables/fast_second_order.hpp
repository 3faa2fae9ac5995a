#pragma once

#include "raytruth/schemes/integral_scheme.hpp"
#include "raytruth/tables/table3.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

struct SlabKernels;

// Tables of second order in binary32, for rendering, into tables that have their axes already: memory that is used
// again costs less than fresh one. Emission is associated; the transfer function is read at the table's entries and
// linear in between. The same bytes on any number of threads.

/// Whether a transfer function is what its values at the table's entries say: all points at entries, no jumps.
bool is_linear_between_entries(const PiecewiseLinear& transfer, const TableAxes& axes);

/// Fills the table by iterations.
void fill_second_order_table(Table3<float>& table, const PiecewiseLinear& transfer, const Iterations& iterations,
                             const SlabKernels& kernels);

/// Fills the table with the continuous integrals: at most 5 * 10^-6 from the certified ones for colours up to 1. Slabs
/// deeper than 24 between two neighbouring entries are certified ones, which takes longer.
void fill_exact_second_order_table(Table3<float>& table, const PiecewiseLinear& transfer, const SlabKernels& kernels);

}  // namespace raytruth
