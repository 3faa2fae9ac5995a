#pragma once

#include "raytruth/render/scene.hpp"
#include "raytruth/shading/point_light.hpp"
#include "raytruth/tables/lit/moment_table.hpp"

#include <Eigen/Core>

#include <cstddef>

namespace raytruth {

/// The table of moments from which a scene lights its slabs.
class ShadedTable {
 public:
  /// The builder `exact` integrates every entry, `subrange_means` makes them by subranges (tables/moments.hpp). Throws
  /// InputError for others, for tables beyond MomentTable's, and for methods that no table can have.
  ShadedTable(const Scene& scene, const TableAxes& axes);

  /// The slab from `front` to `back`, of a share of the table's length: the opacity is corrected as if the slab were
  /// homogeneous, and all light goes with it.
  [[nodiscard]] Eigen::Array4d operator()(double front, double back, double share, const SlabLight& light) const;

 private:
  void integrate_entries(const Scene& scene);
  void make_by_subranges(const Scene& scene);

  MomentTable table_;
  TableFilter filter_;
};

}  // namespace raytruth
