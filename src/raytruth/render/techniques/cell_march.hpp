#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/kernels/linear_piece.hpp"
#include "raytruth/reference/knot_cut.hpp"
#include "raytruth/reference/linear_interval.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/render/techniques/padded_voxels.hpp"
#include "raytruth/schemes/omissions.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/volume/grid.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace raytruth {

/// The cubic of every cell that a ray crosses (`cell_cubic`), for images: the walk in binary64 without the last digits
/// of `trace_trilinear`, from voxels in binary32 where that holds them exactly, else in binary64. Cells whose eight
/// voxels are clear are known beforehand and passed over; others are cut where they cross the transfer function's
/// points. Parts that are not deep are integrated side by side by a rule of Gauss (CellKernels), all others by
/// RayIntegral. A ray ends where less than 2^-30 of the light behind it would be seen. Reads what it is made of; one
/// `CellRay` per thread.
///
/// Only for transfer functions that are linear in extinction; the scheme itself (scheme_pixels) does the others.
class CellMarch {
 public:
  using Voxels = std::variant<PaddedVoxels<float>, PaddedVoxels<double>>;

  /// Throws InputError for voxels beyond 2^500, and as RayIntegral does.
  CellMarch(const Grid& grid, Border border, const PiecewiseLinear& transfer, Emission emission, double opaque);

  [[nodiscard]] const std::array<std::int64_t, 3>& size() const { return size_; }
  [[nodiscard]] Border border() const { return border_; }
  [[nodiscard]] const Voxels& voxels() const { return voxels_; }
  [[nodiscard]] const LinearIntervals& intervals() const { return intervals_; }
  [[nodiscard]] Emission emission() const { return emission_; }
  [[nodiscard]] double opaque() const { return opaque_; }

  /// Whether the cell whose low corner is this padded voxel is clear.
  [[nodiscard]] bool is_clear(std::int64_t voxel) const {
    return (clear_cells_[static_cast<std::size_t>(voxel >> 6)] >> (voxel & 63) & 1) != 0;
  }

 private:
  template <class Number>
  void find_clear_cells(const PaddedVoxels<Number>& voxels, const ClearScalars& clear);

  std::array<std::int64_t, 3> size_;
  Border border_;
  Voxels voxels_;
  LinearIntervals intervals_;
  Emission emission_;
  double opaque_;
  std::vector<std::uint64_t> clear_cells_;  ///< a bit for every padded voxel
};

/// The march along one ray after the other.
class CellRay {
 public:
  CellRay(const CellMarch& march, const PiecewiseLinear& transfer, Emission emission)
      : march_(march), integrate_(transfer, emission) {}

  /// Light and opacity, and `parts`, as TableMarch has them.
  Eigen::Array4d operator()(const PixelRay& pixel, const std::optional<std::span<const RayPart>>& parts);

 private:
  struct Cell {
    Bernstein<3> cubic;
    double length;
  };

  /// Cells side by side, and where their light goes.
  struct Batch {
    LinearPiece<3, Eight> cells;
    std::array<std::size_t, lane_count> index{};
    std::array<std::size_t, lane_count> interval{};
    std::size_t count = 0;
    double most_depth = 0;
  };

  template <class Number>
  void collect_from(const PaddedVoxels<Number>& voxels, const PixelRay& pixel, double begin, double end);
  void collect(const PixelRay& pixel, double begin, double end);
  void composite(Eigen::Array4d& sum);
  void integrate_cells();
  void add_part(const Bernstein<3>& cubic, double length, std::size_t interval);
  void integrate_batch();

  const CellMarch& march_;
  RayIntegral integrate_;
  Chain<3> single_;
  std::vector<Cell> cells_;  ///< those that are not clear, in order
  KnotCut cut_;
  std::vector<KnotStretch> stretches_;
  std::vector<Eigen::Array4d> lights_;  ///< of cells, or of their parts
  Batch batch_;
};

}  // namespace raytruth
