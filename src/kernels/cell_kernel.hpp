#pragma once

#include "kernels/cell_kernels.hpp"
#include "kernels/exponential.hpp"
#include "kernels/gauss_legendre.hpp"
#include "kernels/lanes.hpp"

#include <array>
#include <cstddef>

namespace raytruth::inline RAYTRUTH_LEVEL {

/// See CellKernels.
inline CellLight integrate_cells(const LinearPiece<3, Eight>& cells, bool associated, std::size_t nodes) {
  constexpr std::size_t degree = 3;
  const Lanes length(cells.length);
  const Lanes quarter = length * (1.0 / (degree + 1));
  const Lanes at_0(cells.extinction_at_0);
  const Lanes slope = Lanes(cells.extinction_at_1) - at_0;
  std::array<Lanes, degree + 1> x;
  std::array<Lanes, degree + 1> depth;  // but for the first coefficient, 0
  Lanes whole{};
  for (std::size_t j = 0; j <= degree; ++j) {
    x[j] = Lanes(cells.x[j]);
    whole = multiply_add(quarter, multiply_add(slope, x[j], at_0), whole);
    depth[j] = whole;
  }
  const auto& table = node_table<degree>(nodes);
  Lanes weight_0{};
  Lanes weight_1{};
  for (std::size_t i = 0; i < nodes; ++i) {
    Lanes x_here{};
    Lanes depth_here{};
    for (std::size_t j = 0; j <= degree; ++j) {
      x_here = multiply_add(Lanes(table.signal_basis[j][i]), x[j], x_here);
      depth_here = multiply_add(Lanes(table.depth_basis[j + 1][i]), depth[j], depth_here);
    }
    Lanes density = table.weights[i] * exponential(-depth_here);
    if (associated) density *= multiply_add(slope, x_here, at_0);
    weight_1 = multiply_add(density, x_here, weight_1);
    weight_0 += density;
  }
  weight_0 -= weight_1;
  return {Eight(length * weight_0), Eight(length * weight_1), Eight(exponential(-whole))};
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
