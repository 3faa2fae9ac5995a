#pragma once

#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace raytruth {

/// Tetrahedra that meet face to face, with a scalar that is linear in each, or constant.
struct TetrahedralMesh {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< indices of points; det(v1 - v0, v2 - v0, v3 - v0) > 0
  std::vector<double> scalars;                           ///< one for each point; empty: `cell_scalars` counts
  std::vector<double> cell_scalars;                      ///< one for each tetrahedron
  /// For each point the first one at the same place, so that blocks that state their border twice still meet there.
  std::vector<std::uint32_t> places;
};

/// Checks a mesh as it was read, turns round tetrahedra of negative orientation, and fills in `places`. Throws
/// InputError with the cell's number for an index out of range, a volume of zero, a face of three cells, and for two
/// cells that lie on one side of the face they share, as those of a mesh that folds do; with the point's number for
/// coordinates that are not finite or beyond 2^250; and for scalars that are not finite or as many as neither points
/// nor cells. Orientations are decided exactly. Cells that overlap without sharing a face are found by the rays that
/// meet them.
void complete(TetrahedralMesh& mesh);

/// Into how many tetrahedra a cube of eight voxel centres is split.
enum class GridSplit { five = 5, six = 6 };

/// Which of the cubes i + j + k of a split into five has the corners 0, 3, 5 and 6 as its inner tetrahedron.
enum class SplitParity { even, odd };

/// The mesh whose points are the voxel centres, in voxel coordinates: it ends there (`Border::voxel_centres`). Corners
/// of a cube are b = x + 2 y + 4 z. Five: 0356, 1053, 2036, 4065, 7356 where i + j + k is even, and 1247, 0124, 3172,
/// 5147, 6274 elsewhere, as vtkDataSetTriangleFilter has it; `odd` exchanges them. Six (Kuhn): 0, e_a, e_a + e_b, 7 for
/// the six orders of the axes, whatever the parity. Throws InputError for grids of one layer, which have no cube, and
/// for more points than 32 bits count.
TetrahedralMesh split_grid(const Grid& grid, GridSplit split, SplitParity parity = SplitParity::even);

}  // namespace raytruth
