#pragma once

#include "raytruth/tables/quadratic_gray_table.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <vector>

namespace raytruth {

struct SlabKernels;

// Quadratic tables in binary32. On a diagonal, back - front and a being the same, M - S_f is, and so all slabs meet the
// table's entries at the same places of their way: what a diagonal's slabs are cut at, and the nodes between, are
// computed once. The transfer function's points must be entries (`is_linear_between_entries`). The same bytes on any
// number of threads.

/// Fills the table: at most 10^-5 from the certified one for colours up to 1.
void fill_quadratic_gray_table(QuadraticGrayTable<float>& table, const PiecewiseLinear& transfer, Emission emission,
                               const SlabKernels& kernels);

/// The opacities alone, in the same order, a number for each entry. The weights of a diagonal's gray values are one
/// vector: a correlation, n^3 multiplications for each curvature and no exponential but one for an entry.
std::vector<float> quadratic_gray_opacities(const TableAxes& axes, const RadiusAxis& radius,
                                            const PiecewiseLinear& transfer, const SlabKernels& kernels);

}  // namespace raytruth
