#pragma once

#include "raytruth/tables/look_up.hpp"
#include "raytruth/tables/table_builder.hpp"

namespace raytruth {

/// Whether `table_for_format` takes the builder's way in binary32: it has one, the numbers are stored in binary32 or
/// less, and no colour is above 1, up to where its error is known.
bool is_made_in_binary32(const TableBuilder& builder, const PiecewiseLinear& transfer, const TableFormat& format);

/// The builder's table, its numbers not yet rounded to the format that will hold them: within 10^-5 of the builder's
/// own where `is_made_in_binary32`, else those. Throws as the builder.
Table<double> table_for_format(const TableBuilder& builder, const PiecewiseLinear& transfer, const TableAxes& axes,
                               Emission emission, const TableFormat& format);

}  // namespace raytruth
