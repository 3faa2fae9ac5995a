#pragma once

#include "raytruth/render/scene.hpp"
#include "raytruth/shading/point_light.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace raytruth {

/// Tables of the moments of slabs, from which a renderer lights first-order slabs (Guetat 2010, section 5): with x from
/// 0 at the front to 1 at the back of a slab, the integrals of x^k q T and x^k e T, k = 0 to 3, that of white light
/// under a tent, and the opacity.
///
/// The light along a slab is taken for the cubic through its values at 0, 1/3, 2/3 and 1. So tables are exact, but for
/// their resolution, where a method's light is a polynomial of degree 3: where no cosine changes its sign and no
/// highlight begins within the slab, and the highlight is linear in the cosine. Where it is not, this is what a
/// renderer with these tables shows.
class ShadedTable {
 public:
  /// The builder `exact` integrates every entry, `subrange_means` makes them by subranges (tables/moments.hpp). Throws
  /// InputError for others, for tables beyond `largest_size`, and for methods that no table can have.
  ShadedTable(const Scene& scene, const TableAxes& axes);

  /// A table takes 144 bytes for each entry.
  static constexpr std::size_t largest_size = 1024;

  /// The slab from `front` to `back`, of a share of the table's length: the opacity is corrected as if the slab were
  /// homogeneous, and all light goes with it.
  [[nodiscard]] Eigen::Array4d operator()(double front, double back, double share, const SlabShader& shader,
                                          const LightModel& model) const;

 private:
  static constexpr int powers = 4;
  static constexpr int tent = 4 * powers;
  static constexpr int opacity = tent + 1;
  /// q (3) and e (1) for every power, the tent, the opacity.
  using Entry = Eigen::Array<double, opacity + 1, 1>;

  void integrate_entries(const Scene& scene);
  void make_by_subranges(const Scene& scene);
  [[nodiscard]] Entry& at(std::size_t front, std::size_t back) { return entries_[back * axes_.size + front]; }
  [[nodiscard]] const Entry& at(std::size_t front, std::size_t back) const {
    return entries_[back * axes_.size + front];
  }
  [[nodiscard]] Entry look_up(double front, double back) const;

  TableAxes axes_;
  TableFilter filter_;
  std::vector<Entry> entries_;
};

}  // namespace raytruth
