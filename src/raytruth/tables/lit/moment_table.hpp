#pragma once

#include "raytruth/shading/point_light.hpp"
#include "raytruth/shading/slab_optics.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/tables/table.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace raytruth {

/// A method's light on one slab.
struct SlabLight {
  SlabShader shader;
  LightModel model;
};

/// Tables of the moments of slabs, from which a renderer lights first-order slabs (Guetat 2010, section 5): with x from
/// 0 at the front to 1 at the back of a slab, the integrals of x^k q T and x^k e T, k = 0 to 3, that of white light
/// under a tent, and the opacity.
///
/// The light along a slab is taken for the cubic through its values at 0, 1/3, 2/3 and 1. So tables are exact, but for
/// their resolution, where a method's light is a polynomial of degree 3: where no cosine changes its sign and no
/// highlight begins within the slab, and the highlight is linear in the cosine. Where it is not, this is what a
/// renderer with these tables shows.
class MomentTable {
 public:
  static constexpr int powers = 4;
  static constexpr int tent = 4 * powers;
  static constexpr int opacity = tent + 1;
  /// q (3) and e (1) for every power, the tent, the opacity.
  using Entry = Eigen::Array<double, opacity + 1, 1>;

  /// A table takes 144 bytes for each entry.
  static constexpr std::size_t largest_size = 1024;

  /// Whether a method's light depends on the normals at both ends of a slab only, and is seen through moments of matter
  /// or white.
  static bool takes(const Shading& method);

  /// A table of zeros. Throws InputError as `check` of the axes does, and for tables beyond `largest_size`.
  explicit MomentTable(const TableAxes& axes);

  [[nodiscard]] const TableAxes& axes() const { return axes_; }
  [[nodiscard]] Entry& at(std::size_t front, std::size_t back) { return entries_[back * axes_.size + front]; }
  [[nodiscard]] const Entry& at(std::size_t front, std::size_t back) const {
    return entries_[back * axes_.size + front];
  }

  /// The entry of a slab, integrated to about 1e-14.
  static Entry entry_of(const SlabOptics& optics, Emission emission);

  /// Bilinear between the entries around, or the nearest one.
  [[nodiscard]] Entry look_up(double front, double back, bool is_nearest = false) const;

  /// The slab of an entry, lit, colour and opacity.
  static Eigen::Array4d lit(const Entry& slab, const SlabLight& light);

 private:
  TableAxes axes_;
  std::vector<Entry> entries_;
};

}  // namespace raytruth
