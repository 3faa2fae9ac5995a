#pragma once

#include "core/chain.hpp"
#include "reference/ray_integral.hpp"
#include "render/padded_voxels.hpp"
#include "schemes/omissions.hpp"
#include "transfer/clear_scalars.hpp"
#include "volume/camera.hpp"
#include "volume/grid.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace raytruth {

/// The cubic of every cell that a ray crosses (`cell_cubic`), for images: the walk in binary64 without the last digits
/// of `trace_trilinear`, from voxels in binary32. Cells whose cubic is clear are passed over, all others integrated by
/// RayIntegral. Reads what it is made of; one `CellRay` per thread.
class CellMarch {
 public:
  /// Throws InputError for voxels beyond the range of binary32.
  CellMarch(const Grid& grid, const PiecewiseLinear& transfer, Emission emission, double opaque);

  [[nodiscard]] const std::array<std::int64_t, 3>& size() const { return size_; }
  [[nodiscard]] const PaddedVoxels& voxels() const { return voxels_; }
  [[nodiscard]] const ClearScalars& clear() const { return clear_; }
  [[nodiscard]] double opaque() const { return opaque_; }

 private:
  std::array<std::int64_t, 3> size_;
  PaddedVoxels voxels_;
  ClearScalars clear_;
  double opaque_;
};

/// The march along one ray after the other.
class CellRay {
 public:
  CellRay(const CellMarch& march, const PiecewiseLinear& transfer, Emission emission)
      : march_(march), integrate_(transfer, emission) {}

  /// As TableMarch's.
  Eigen::Array4d operator()(const PixelRay& pixel, const std::optional<std::span<const RayPart>>& parts);

 private:
  void collect(const PixelRay& pixel, double begin, double end);
  void composite(Eigen::Array4d& sum);

  const CellMarch& march_;
  RayIntegral integrate_;
  Chain<3> visible_;  ///< what is not clear, put together
};

}  // namespace raytruth
