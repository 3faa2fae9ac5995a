#pragma once

#include "raytruth/schemes/omissions.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace raytruth {

/// What a min-max block is asked about the scalars in it (Lee 2010, section 3.2).
enum class BlockBounds {
  unrefined,  ///< they lie in [m, M], the range of its voxels
  printed,    ///< and up to (M - m)/8 beyond, eq. 8: right only if all samples that a virtual one is made of lie in it
  corrected,  ///< the same of a block grown by the reach of the samples
};

inline constexpr std::array<std::string_view, 3> block_bounds_names{"unrefined", "printed", "corrected"};

/// How the range of a block is made: of the voxels up to `growth` beyond it, and wider by `overshoot` (M - m).
struct BlockRefinement {
  std::int64_t growth = 0;
  double overshoot = 0;
  double margin = 0;  ///< on either side, in units of the scalar
};

/// The blocks of a grid in which there may be something to see: those whose ranges are not clear. Blocks hold the cells
/// between `size`^3 voxels and the next ones, so that neighbours share a layer of voxels; those at the ends also hold
/// the clamped halves.
class OccupiedBlocks {
 public:
  /// Throws InputError unless size >= 1.
  OccupiedBlocks(const Grid& grid, const ClearScalars& clear, std::int64_t size, const BlockRefinement& refinement);

  /// The parts of a ray in occupied blocks, in order and disjoint; each longer by a millionth of a voxel at either end,
  /// so that none is missed by rounding; in voxels from where it enters the grid. `entry` is where the ray, at a unit
  /// direction, enters the grid; it ends `length` behind it. `parts` is overwritten.
  void parts(const std::array<double, 3>& entry, const std::array<double, 3>& direction, double length,
             std::vector<RayPart>& parts) const;

  /// The share of all blocks that is occupied.
  [[nodiscard]] double share() const;

  [[nodiscard]] const std::array<std::int64_t, 3>& count() const { return count_; }
  [[nodiscard]] bool is_occupied(std::int64_t i, std::int64_t j, std::int64_t k) const { return at(i, j, k) != 0; }

 private:
  [[nodiscard]] unsigned char at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return occupied_[static_cast<std::size_t>((k * count_[1] + j) * count_[0] + i)];
  }

  std::int64_t size_;
  std::array<std::int64_t, 3> count_{};
  std::vector<unsigned char> occupied_;
};

}  // namespace raytruth
