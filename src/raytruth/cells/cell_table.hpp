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
  slope,              ///< as mean_depth, with distances by scalar, D / |back - front|, linear in their logarithm
};

inline constexpr std::array<std::string_view, 6> cell_table_axis_names{
    "uniform", "powers_of_two", "powers_of_two_log", "mean_depth", "printed", "slope"};

/// How the entries of a table for cells are made.
enum class CellTableEntries {
  exact,        ///< `exact_table`
  brute_force,  ///< `brute_force_table` of mean intervals, for each distance
  subrange,     ///< `subrange_table` of the same
  /// The first distance exactly; the slab of k steps is one of one step, and behind it that of k - 1 from the entry
  /// nearest to the scalar between (VTK's vtkUnstructuredGridPreIntegration, by default). For equal distances.
  incremental,
};

inline constexpr std::array<std::string_view, 4> cell_table_entries_names{"exact", "brute_force", "subrange",
                                                                          "incremental"};

/// A pre-integration table for cells, in which slabs have any length up to the longest (Lum 2004, section 4.2; the
/// dissertation, section 5.2.5): a table over (front, back) for each of its distances. Distances have nothing in common
/// but the runs of slabs that their subranges are made of, whose lengths D / |j - i| differ from one to the next.
///
/// `mean_depth` needs no distances for opacity: a slab's depth is D times the mean m of the extinction between front
/// and back, which is a table over two scalars. What is left to be interpolated is the colour of the slab as a whole,
/// which depends on D far less than opacity does. `slope` has the same opacity; its slabs of one slope append to each
/// other, C(i, j + 1) = C(i, j) over C(j, j + 1), so that n^2 composites fill a distance without subranges.
struct CellTable {
  CellTableAxis axis = CellTableAxis::uniform;
  std::vector<double> distances;  ///< ascending; of `slope` for a difference of scalars of 1
  std::vector<Table<double>> slices;
  std::vector<double> mean_extinctions;  ///< of `mean_depth` and `slope`: back slowest

  /// The numbers of a table with four channels, or three and one for all distances.
  [[nodiscard]] std::size_t numbers() const;
};

/// The distances of an axis for slabs up to the longest. `printed` has 10, whatever the count and the longest; those of
/// `slope` reach from 1/64 of the longest to 1024 times it. Throws InputError for fewer than
/// two, of `slope` three.
std::vector<double> cell_table_distances(CellTableAxis axis, std::size_t count, double longest);

/// A table; of `slope` the entries are exact slabs of neighbours, appended. `axes.length` is not looked at. Throws
/// InputError as `exact_table` does, and for entries that the axis does not have: `slope` has exact ones, and
/// `uniform` alone incremental ones.
CellTable cell_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission, CellTableAxis axis,
                     const std::vector<double>& distances, CellTableEntries entries = CellTableEntries::exact);

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
