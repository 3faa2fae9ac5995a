#pragma once

#include "raytruth/gl/device.hpp"
#include "raytruth/schemes/integral_scheme.hpp"
#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table3.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

// Tables made by compute shaders (table_builds.glsl), an invocation for each entry. Throw MissingError for what is
// beyond the device.

/// `brute_force_table` in a shader.
Table<float> brute_force_table_in_shader(GlDevice& device, const DiscreteTransfer& transfer, const TableAxes& axes);

/// `fill_second_order_table` in a shader, for either emission: the transfer function is read at the table's entries and
/// linear in between.
Table3<float> second_order_table_in_shader(GlDevice& device, const PiecewiseLinear& transfer, const TableAxes& axes,
                                           Emission emission, const Iterations& iterations);

}  // namespace raytruth
