#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table_cost.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace raytruth {

/// How a table over (front, back, D) goes from its distances to any other D.
enum class CellTableAxis {
  uniform,            ///< 0 to the longest in equal steps, linear between them
  powers_of_two,      ///< 0, then each twice the one before up to the longest, linear between them
  powers_of_two_log,  ///< the same, linear in log D; from 0 to the first one in D
  mean_depth,         ///< as uniform; opacity is 1 - exp(-D m), and colour over opacity is linear in D
  printed,            ///< 0, then 2^j for j = -7 to 1, linear between them (the dissertation, section 5.2.5)
};

inline constexpr std::array<std::string_view, 5> cell_table_axis_names{"uniform", "powers_of_two", "powers_of_two_log",
                                                                       "mean_depth", "printed"};

/// A pre-integration table for cells, in which slabs have any length up to the longest (Lum 2004, section 4.2; the
/// dissertation, section 5.2.5): a table over (front, back) for each of its distances. Distances have nothing in common
/// but the runs of slabs that their subranges are made of, whose lengths D / |j - i| differ from one to the next.
///
/// `mean_depth` needs no distances for opacity: a slab's depth is D times the mean m of the extinction between front
/// and back, which is a table over two scalars. What is left to be interpolated is the colour of the slab as a whole,
/// which depends on D far less than opacity does.
struct CellTable {
  CellTableAxis axis = CellTableAxis::uniform;
  std::vector<double> distances;  ///< ascending
  std::vector<Table<double>> slices;
  std::vector<double> mean_extinctions;  ///< of `mean_depth`: back slowest

  /// The numbers of a table with four channels, or three and one for all distances.
  [[nodiscard]] std::size_t numbers() const;
};

/// The distances of an axis. `printed` has 10, whatever the count and the longest. Throws InputError for fewer than
/// two.
std::vector<double> cell_table_distances(CellTableAxis axis, std::size_t count, double longest);

/// A table with exact entries (`exact_table`). `axes.length` is not looked at. Throws InputError as that does.
CellTable exact_cell_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                           CellTableAxis axis, const std::vector<double>& distances);

/// Its slab: linear in both scalars, and as the axis has it in D. Scalars and distances beyond the ends are those of
/// the ends.
Rules<double>::vec4 look_up(const CellTable& table, double front, double back, double length);

/// The mean of the extinction of slabs from one scalar to another.
double mean_extinction(const PiecewiseLinear& transfer, double front, double back);

/// What a table of n scalars and so many distances takes entry by entry, and by Lum's subranges, each distance by
/// itself.
TableCost brute_force_cell_table_cost(std::int64_t size, std::int64_t distances);
TableCost subrange_cell_table_cost(std::int64_t size, std::int64_t distances);

}  // namespace raytruth
