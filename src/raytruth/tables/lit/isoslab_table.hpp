#pragma once

#include "raytruth/schemes/outcome.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/tables/lit/moment_table.hpp"
#include "raytruth/transfer/isoslab.hpp"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace raytruth {

/// A table of isoslabs: of slabs between two scalars that meet the boxes around isosurfaces.
class IsoslabTable {
 public:
  /// `axes`: of `isoslab.size` entries; their length is the sampling step, which is nothing to per_crossing.
  /// Throws InputError as `isoslab_transfer` and MomentTable do.
  IsoslabTable(const std::vector<Isosurface>& surfaces, IsoslabDensity density, const Isoslab& isoslab,
               const TableAxes& axes);

  /// The slab from `front` to `back`, of this length: per_length its opacity is corrected to it.
  [[nodiscard]] Eigen::Array4d operator()(double front, double back, double length, const SlabLight& light) const;

 private:
  bool is_per_crossing_;
  MomentTable table_;
};

/// The light of a ray whose slabs are looked up. `light_of(begin, end)`: of the slab between two samples at these t;
/// empty: the surfaces' own colours.
Outcome<> isoslab_light(const IsoslabTable& table, const Samples<double>& samples,
                        const std::function<SlabLight(double begin, double end)>& light_of = {});

}  // namespace raytruth
