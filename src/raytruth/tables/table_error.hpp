#pragma once

#include "raytruth/tables/look_up.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// Look-ups are compared at 4 x 4 places inside a cell: off the entries, symmetric, and off the multiples of 2^-8 of
/// its width, where a texture unit's weights would be exact.
inline constexpr std::array places_of_axis{0.1, 0.37, 0.63, 0.9};
inline constexpr std::size_t places_per_axis = places_of_axis.size();

/// A cell between four entries of a table, and the certified slabs at its places and at its entries.
struct CertifiedCell {
  using vec4 = Rules<double>::vec4;

  std::size_t front = 0;  ///< the entry before
  std::size_t back = 0;
  double weight = 0;       ///< cells of the table that it stands for
  double band_weight = 0;  ///< cells of the diagonal band that it stands for
  std::array<vec4, places_per_axis * places_per_axis> slabs{};
  std::array<vec4, 4> entries{};

  /// |i - j| <= 1.
  [[nodiscard]] bool is_in_band() const { return front <= back + 1 && back <= front + 1; }
  /// What an exact table has at one of its four entries.
  [[nodiscard]] vec4 entry(std::size_t at_front, std::size_t at_back) const {
    return entries[2 * (at_back - back) + (at_front - front)];
  }
};

/// Cells of a table whose look-ups are judged.
struct CertifiedCells {
  TableAxes axes;
  std::vector<CertifiedCell> cells;
  double radius = 0;  ///< bound on the error of all slabs
};

/// All cells of a table of up to `most` + 1 entries; of larger ones one cell, drawn by the seed, of each of `most` x
/// `most` blocks, and as many places along the diagonal with the three cells of its band. Errors gather where the
/// transfer function has points: up to eight cells along an axis that hold some are blocks of their own; of more, up to
/// `most` diagonal ones are looked at for the largest error alone. The slabs are linear in the scalar, and by the
/// reference.
CertifiedCells certified_cells(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                               std::size_t most, std::uint64_t seed);

/// Front and back scalar of a place in a cell.
std::array<double, 2> place_of(const TableAxes& axes, const CertifiedCell& cell, std::size_t place);

/// Errors of look-ups, colours and opacities alike.
struct TableError {
  double max = 0;               ///< largest of all places and channels
  double mean = 0;              ///< of magnitudes over the table's area and the four channels
  double root_mean_square = 0;  ///< likewise
  double band_max = 0;
  double band_mean = 0;
  double outside_max = 0;  ///< largest outside the diagonal band
  double front = 0;        ///< scalars where it is largest
  double back = 0;
};

/// What look_up(cell, {front, back}) gives, minus the truth.
template <class LookUp>
TableError table_error(const CertifiedCells& truth, const LookUp& look_up) {
  TableError error;
  double area = 0;
  double band_area = 0;
  const TableAxes& axes = truth.axes;
  for (const CertifiedCell& cell : truth.cells) {
    double sum = 0;
    double sum_of_squares = 0;
    double largest = 0;
    for (std::size_t i = 0; i < cell.slabs.size(); ++i) {
      const std::array<double, 2> scalars = place_of(axes, cell, i);
      const CertifiedCell::vec4 magnitude = (look_up(cell, scalars) - cell.slabs[i]).abs();
      sum += magnitude.mean();
      sum_of_squares += magnitude.square().mean();
      largest = std::max(largest, magnitude.maxCoeff());
      if (magnitude.maxCoeff() > error.max) {
        error.max = magnitude.maxCoeff();
        error.front = scalars[0];
        error.back = scalars[1];
      }
    }
    double& side = cell.is_in_band() ? error.band_max : error.outside_max;
    side = std::max(side, largest);
    constexpr double places = places_per_axis * places_per_axis;
    error.mean += cell.weight * sum / places;
    error.root_mean_square += cell.weight * sum_of_squares / places;
    error.band_mean += cell.band_weight * sum / places;
    area += cell.weight;
    band_area += cell.band_weight;
  }
  error.mean /= area;
  error.root_mean_square = std::sqrt(error.root_mean_square / area);
  error.band_mean /= band_area;
  return error;
}

/// The error of bilinear look-ups in a table of this format, whose entries are entry(cell, front, back).
template <class Entry>
TableError bilinear_error(const CertifiedCells& truth, const Entry& entry, const TableFormat& format = {},
                          int weight_bits = 0) {
  return table_error(truth, [&](const CertifiedCell& cell, const std::array<double, 2>& scalars) {
    return bilinear<double>(
        truth.axes,
        [&](std::size_t front, std::size_t back) -> CertifiedCell::vec4 {
          return entry(cell, front, back).unaryExpr([&](double value) { return stored(format, value); });
        },
        scalars, weight_bits);
  });
}

}  // namespace raytruth
