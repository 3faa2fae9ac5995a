#pragma once

#include "raytruth/kernels/cell_kernels.hpp"
#include "raytruth/kernels/piece_kernel.hpp"

#include <cstddef>
#include <numbers>

namespace raytruth::inline RAYTRUTH_LEVEL {

template <class Sums, int Degree>
Sums sums_over_nodes(const Integrand<Degree, Lanes>& integrand, std::size_t nodes) {
  const auto& table = node_table<Degree>(nodes);
  Sums sums;
  for (std::size_t i = 0; i < nodes; ++i) sums.add(table, integrand, [i](const NodeRow& row) { return Lanes(row[i]); });
  return sums;
}

/// See CellKernels: the sums of a certified piece; those that bound its errors vanish where all is in one function.
[[gnu::flatten]] inline CellLight integrate_cells(const LinearPiece<3, Eight>& cells, bool associated,
                                                  std::size_t nodes) {
  constexpr std::size_t degree = 3;
  const Lanes length(cells.length);
  const Lanes at_0(cells.extinction_at_0);
  const Lanes slope = Lanes(cells.extinction_at_1) - at_0;
  const Lanes share = length * (-std::numbers::log2e / (degree + 1));
  Integrand<degree, Lanes> integrand;
  Lanes exponent{};
  for (std::size_t j = 0; j <= degree; ++j) {
    const Lanes x(cells.x[j]);
    exponent = multiply_add(share, multiply_add(slope, x, at_0), exponent);
    integrand.x[j] = x;
    integrand.exponent[j] = exponent;
    if (j > 0) integrand.rate[j - 1] = static_cast<double>(degree) * (x - integrand.x[j - 1]);
  }
  const Lanes opacity = 0.0 - PowerOf2(exponent).less_1();
  if (associated) {
    const auto sums = sums_over_nodes<AssociatedSums<degree, Lanes>>(integrand, nodes);
    const Lanes weight_1 = multiply_add(integrand.x[degree], opacity, sums.light);
    return {Eight(opacity - weight_1), Eight(weight_1), Eight(opacity)};
  }
  const auto sums = sums_over_nodes<PlainSums<degree, Lanes>>(integrand, nodes);
  return {Eight(length * (sums.transmitted - sums.light)), Eight(length * sums.light), Eight(opacity)};
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
