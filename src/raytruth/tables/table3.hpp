#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/tables/table.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// The largest table of slabs of second order, of an 8-bit scalar: in binary32 it takes 256 MiB.
inline constexpr std::size_t largest_table3_size = 256;

/// A table of slabs of second order (El Hajjar 2008, section 6): the scalar is the parabola through `front`, `middle`
/// and `back` at 0, 1/2 and 1 of the slab, whose whole length is that of the axes. Shape (back, middle, front, 4), C
/// order; RGBA as in Table.
template <class Real>
struct Table3 {
  TableAxes axes;
  std::vector<Real> values;

  Table3() = default;
  /// Zeros. Throws InputError as `check` does, and above largest_table3_size.
  explicit Table3(const TableAxes& its_axes) : axes(its_axes) {
    check(axes);
    if (axes.size > largest_table3_size)
      throw InputError(fmt::format("found a table of {} entries along three axes; 2 to {} are allowed", axes.size,
                                   largest_table3_size));
    values.resize(axes.size * axes.size * axes.size * 4);
  }

  [[nodiscard]] Real* texel(std::size_t front, std::size_t middle, std::size_t back) {
    return values.data() + 4 * ((back * axes.size + middle) * axes.size + front);
  }
  [[nodiscard]] const Real* texel(std::size_t front, std::size_t middle, std::size_t back) const {
    return values.data() + 4 * ((back * axes.size + middle) * axes.size + front);
  }

  [[nodiscard]] Eigen::Array<Real, 4, 1> at(std::size_t front, std::size_t middle, std::size_t back) const {
    return Eigen::Map<const Eigen::Array<Real, 4, 1>>(texel(front, middle, back));
  }
  void set(std::size_t front, std::size_t middle, std::size_t back, const Eigen::Array<Real, 4, 1>& slab) {
    Eigen::Map<Eigen::Array<Real, 4, 1>>(texel(front, middle, back)) = slab;
  }
};

}  // namespace raytruth
