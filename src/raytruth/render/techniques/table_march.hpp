#pragma once

#include "raytruth/render/scene.hpp"
#include "raytruth/render/techniques/lanes4.hpp"
#include "raytruth/render/techniques/padded_voxels.hpp"
#include "raytruth/schemes/omissions.hpp"
#include "raytruth/tables/table.hpp"

#include <Eigen/Core>

#include <vector>

namespace raytruth {

/// A first-order pre-integrated ray at equal steps through a trilinear grid, as fast as one may: voxels, table, weights
/// and composites in binary32, positions in binary64. Voxels are scaled to places in the table, which commutes with
/// their interpolation. The last, shorter slab is that of the table with its opacity corrected to its length, as if it
/// were homogeneous. A ray that has become opaque to the last bit ends.
class TableMarch {
 public:
  /// `table` has the axes of a range of the grid and the length `step`.
  TableMarch(const Grid& grid, Border border, const Table<double>& table, TableFilter filter, double step,
             double opaque);

  /// Light in the first three numbers, opacity in the fourth. `parts`: where the ray is looked at, in voxels behind its
  /// entry.
  [[nodiscard]] Eigen::Array4d operator()(const PixelRay& pixel,
                                          const std::optional<std::span<const RayPart>>& parts) const;

 private:
  struct March;

  std::array<std::int64_t, 3> size_;
  Border border_;
  PaddedVoxels<float> voxels_;
  std::vector<float> texels_;
  int entries_;
  TableFilter filter_;
  double step_;
  double opaque_;
};

}  // namespace raytruth
