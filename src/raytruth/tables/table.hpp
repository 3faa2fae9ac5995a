#pragma once

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace raytruth {

/// What a table of pre-integrated slabs is asked: slabs of one length whose scalar is linear from front to back, for
/// `size` scalars at equal distances at either side.
struct TableAxes {
  std::size_t size = 0;  ///< n, at least 2
  double low = 0;        ///< scalar of entry 0
  double high = 1;       ///< scalar of entry n - 1
  double length = 1;     ///< of every slab, above 0

  /// The scalar that entry i stands for.
  [[nodiscard]] double scalar(std::size_t i) const {
    return low + (high - low) * (static_cast<double>(i) / static_cast<double>(size - 1));
  }
};

/// The largest table: 2^14 entries per axis take 4 GiB.
inline constexpr std::size_t largest_table_size = 16384;

/// Throws InputError unless 2 <= size <= largest_table_size, low < high and length > 0, all finite.
inline void check(const TableAxes& axes) {
  if (axes.size < 2 || axes.size > largest_table_size)
    throw InputError(
        fmt::format("found a table of {} entries per axis; 2 to {} are allowed", axes.size, largest_table_size));
  if (!(axes.low < axes.high) || !std::isfinite(axes.high - axes.low))
    throw InputError(
        fmt::format("found a table from scalar {} to {}; finite, ascending ones are allowed", axes.low, axes.high));
  if (!(axes.length > 0) || !std::isfinite(axes.length))
    throw InputError(fmt::format("found slabs of length {}; a finite number > 0 is allowed", axes.length));
}

/// A table of slabs, RGBA: the light that a slab sends to its front (opacity-weighted colour), and its opacity. Shape
/// (back, front, 4), C order. Real is double for checks, float for use.
template <class Real>
struct Table {
  using Texel = Eigen::Array<Real, 4, 1>;

  TableAxes axes;
  std::vector<Real> values;

  Table() = default;
  /// Zeros. Throws InputError as `check` does.
  explicit Table(const TableAxes& its_axes) : axes(its_axes) {
    check(axes);
    values.resize(axes.size * axes.size * 4);
  }

  [[nodiscard]] Real* texel(std::size_t front, std::size_t back) {
    return values.data() + 4 * (back * axes.size + front);
  }
  [[nodiscard]] const Real* texel(std::size_t front, std::size_t back) const {
    return values.data() + 4 * (back * axes.size + front);
  }

  [[nodiscard]] Texel at(std::size_t front, std::size_t back) const {
    return Eigen::Map<const Texel>(texel(front, back));
  }
  void set(std::size_t front, std::size_t back, const Texel& slab) { Eigen::Map<Texel>(texel(front, back)) = slab; }
};

/// A table's numbers, rounded to float.
inline Table<float> rounded(const Table<double>& table) {
  Table<float> result(table.axes);
  for (std::size_t i = 0; i < table.values.size(); ++i) result.values[i] = static_cast<float>(table.values[i]);
  return result;
}

}  // namespace raytruth
