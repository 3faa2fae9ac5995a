#pragma once

#include "raytruth/tables/look_up.hpp"
#include "raytruth/tables/quadratic_gray_table.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table3.hpp"
#include "raytruth/tables/table_builder.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace raytruth {

/// How far look-ups in a table, its numbers as a reader of its file gets them, are from certified slabs, off its nodes:
/// all channels, magnitudes.
struct LookUpError {
  std::string_view look_up;  ///< bilinear or trilinear
  double max = 0;
  std::optional<std::array<double, 2>> max_at = {};  ///< front and back scalar there
  double mean = 0;
  double root_mean_square = 0;
  std::optional<double> band_max = {};  ///< the largest one beside the diagonal
  std::uint64_t places = 0;             ///< looked at
  double radius = 0;                    ///< of the certified slabs: a bound on the errors' error
  double rounding = 0;                  ///< the largest of all entries, by the format; clamping is of it
};

/// The error of a table of slabs, by cells of its grid.
LookUpError linear_look_up_error(const Table<double>& table, const PiecewiseLinear& transfer, Emission emission,
                                 const TableFormat& format);

/// The error of a table of weighted light, at random places, each by ball arithmetic.
LookUpError weighted_look_up_error(const Table<double>& table, const TableContent& content,
                                   const PiecewiseLinear& transfer, Emission emission, const TableFormat& format);

/// The error of a table over three scalars, at random places.
LookUpError second_order_look_up_error(const Table3<float>& table, const PiecewiseLinear& transfer,
                                       const TableAxes& axes, Emission emission, const TableFormat& format);

/// The error of a table of the quadratic gray-value model, at random places within its curvatures. `axes`: those that
/// were asked for, whose range is that of the gray values.
LookUpError quadratic_gray_look_up_error(const QuadraticGrayTable<double>& table, const PiecewiseLinear& transfer,
                                         const TableAxes& axes, Emission emission, const TableFormat& format);

}  // namespace raytruth
