#pragma once

#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/table.hpp"

#include <array>

namespace raytruth {

struct TableKernels;

// Tables in binary32, for rendering: neighbouring diagonals side by side (kernels/band.hpp). They are at most 10^-5
// from those in binary64 for colours up to 1. Plain emission takes extinctions below 10^-20 for that. Tables of the
// right size keep their memory, which fresh ones spend more time on than on the numbers. Bytes are the same on any
// number of threads. All throw InputError as `check` does. `kernels` are those of a level of x86-64; null: the best
// ones that the processor has.

/// `subrange_table`.
void build_subrange_table(const DiscreteTransfer& transfer, const TableAxes& axes, Table<float>& table,
                          const TableKernels* kernels = nullptr);

/// The moments of `moment_tables`, k = 0 to 3: RGB, and white light as the fourth channel; in the associated convention
/// that of k = 0 is the opacity.
void build_moment_tables(const DiscreteTransfer& transfer, const TableAxes& axes, std::array<Table<float>, 4>& tables,
                         const TableKernels* kernels = nullptr);

}  // namespace raytruth
