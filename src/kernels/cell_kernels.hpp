#pragma once

#include "kernels/level.hpp"
#include "kernels/linear_piece.hpp"

#include <cstddef>
#include <vector>

namespace raytruth {

/// Eight cubic pieces' light, uncertified: the weights of PieceIntegral, and 1 - exp(-depth).
struct CellLight {
  Eight weight_0{};
  Eight weight_1{};
  Eight opacity{};
};

/// The inner loop of a renderer that integrates the cubics of cells, in the version for one level of x86-64.
struct CellKernels {
  /// By Gauss's rule of `nodes` nodes, of depths up to 600; `x_error` is not looked at.
  CellLight (*integrate)(const LinearPiece<3, Eight>& cells, bool associated, std::size_t nodes);
};

/// The versions that this processor can run, the best one first.
const std::vector<const CellKernels*>& cell_kernel_versions();

}  // namespace raytruth
