#include "raytruth/tables/lit/moment_table.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/tables/look_up.hpp"

#include <fmt/format.h>

namespace raytruth {

namespace {

/// Powers of x of the cubic through values at 0, 1/3, 2/3 and 1.
const Eigen::Matrix4d& cubic_through() {
  static const Eigen::Matrix4d matrix{{1, 0, 0, 0}, {-5.5, 9, -4.5, 1}, {9, -22.5, 18, -4.5}, {-4.5, 13.5, -13.5, 4.5}};
  return matrix;
}

}  // namespace

bool MomentTable::takes(const Shading& method) {
  return !method.needs_extinction && method.name != "quadratic_arc_fades_printed";
}

MomentTable::MomentTable(const TableAxes& axes) : axes_(axes) {
  check(axes);
  if (axes.size > largest_size)
    throw InputError(
        fmt::format("found a shaded table of {} entries per axis; 2 to {} are allowed", axes.size, largest_size));
  entries_.assign(axes.size * axes.size, Entry::Zero());
}

MomentTable::Entry MomentTable::entry_of(const SlabOptics& optics, Emission emission) {
  const SlabMoments moments = slab_moments(optics, emission);
  Entry entry;
  for (Eigen::Index k = 0; k < powers; ++k) {
    entry.segment<3>(4 * k) = moments.colored[static_cast<std::size_t>(k)];
    entry[4 * k + 3] = moments.white[static_cast<std::size_t>(k)];
  }
  entry[tent] = moments.white[powers];
  entry[opacity] = optics.opacity();
  return entry;
}

MomentTable::Entry MomentTable::look_up(double front, double back, bool is_nearest) const {
  const auto f = TablePlace<double>::of(axes_, front, 0);
  const auto b = TablePlace<double>::of(axes_, back, 0);
  if (is_nearest) return at(f.nearest(), b.nearest());
  const auto row = [&](std::size_t which) -> Entry {
    return at(f.first, which) + f.weight * (at(f.second, which) - at(f.first, which));
  };
  const Entry first = row(b.first);
  return first + b.weight * (row(b.second) - first);
}

Eigen::Array4d MomentTable::lit(const Entry& slab, const SlabLight& light) {
  const auto& [shader, model] = light;
  Eigen::Matrix<double, 4, 4> values;  // matter and white light at four points
  for (int i = 0; i < 4; ++i) {
    const LitPoint point = shader.at(i / 3.0, 0);
    const PointLight here = model(point.diffuse, point.specular);
    values.row(i) << here.matter, here.white.matrix().transpose();
  }
  const Eigen::Matrix<double, 4, 4> cubics = cubic_through() * values;
  Vector3<double> matter = Vector3<double>::Zero();
  Vector3<double> white = Vector3<double>::Zero();
  for (Eigen::Index k = 0; k < powers; ++k) {
    matter += cubics(k, 0) * slab.segment<3>(4 * k);
    white += slab[4 * k + 3] * cubics.row(k).tail<3>().transpose().array();
  }
  // The larger one of the two integrals of the highlight counts.
  if (shader.has_two_highlights) white = white.max(slab[tent] * model(0, shader.at(0.5, 0).other_specular).white);
  Eigen::Array4d result;
  result << matter + white, slab[opacity];
  return result;
}

}  // namespace raytruth
