#pragma once

#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table_cost.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

/// Engel, Kraus and Ertl 2001, section 3.2 (Lum 2004, section 4.2): nothing is attenuated on its way out of a slab.
/// With the integrals K of q and A of tau from the lowest scalar up,
///
///     C = length (K(s_b) - K(s_f)) / (s_b - s_f),  opacity = 1 - exp(-length (A(s_b) - A(s_f)) / (s_b - s_f)),
///
/// two differences for each entry; q length for s_f = s_b. K and A are exact for piecewise linear transfer functions.
/// Throws InputError as `check` does.
Table<double> no_attenuation_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission);

/// One exponential for each entry, since opacities do not depend on the direction: n (n + 1) / 2.
inline TableCost no_attenuation_cost(std::int64_t size) {
  return {.composites = 0, .exponentials = size * (size + 1) / 2};
}

}  // namespace raytruth
