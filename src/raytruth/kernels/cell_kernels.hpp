#pragma once

#include "raytruth/kernels/level.hpp"
#include "raytruth/kernels/linear_piece.hpp"

#include <cstddef>
#include <vector>

namespace raytruth {

/// Eight cubic pieces' light, uncertified: the weights of PieceIntegral, and 1 - exp(-depth).
struct CellLight {
  Eight weight_0{};
  Eight weight_1{};
  Eight opacity{};
};

/// So many nodes for cells whose largest extinction times their length is at most `deepest`. Gauss's rule of n nodes is
/// exact to degree 2n - 1; by parts, with O = Q - Q^2/2 + ..., light has terms of degree 6, 10, 14, ... For any cubic
/// in [0, 1] both rules miss less than 2^-22 of the light (a test tries random and extreme ones), far less where it is
/// smooth.
struct CellRule {
  double deepest;
  std::size_t nodes;
};
inline constexpr CellRule thin_cell{0.5, 6};
inline constexpr CellRule thick_cell{4, 9};

/// The inner loop of a renderer that integrates the cubics of cells, in the version for one level of x86-64.
struct CellKernels {
  /// Integrates by Gauss's rule of `nodes` nodes, depths up to 600; `x_error` is not looked at.
  CellLight (*integrate)(const LinearPiece<3, Eight>& cells, bool associated, std::size_t nodes);
};

/// The versions that this processor can run, the best one first.
const std::vector<const CellKernels*>& cell_kernel_versions();

}  // namespace raytruth
