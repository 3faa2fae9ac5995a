#include "raytruth/render/techniques/shaded_table.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/shading/slab_optics.hpp"
#include "raytruth/tables/moments.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>

namespace raytruth {

namespace {

/// Powers of x of the cubic through values at 0, 1/3, 2/3 and 1.
const Eigen::Matrix4d& cubic_through() {
  static const Eigen::Matrix4d matrix{{1, 0, 0, 0}, {-5.5, 9, -4.5, 1}, {9, -22.5, 18, -4.5}, {-4.5, 13.5, -13.5, 4.5}};
  return matrix;
}

}  // namespace

ShadedTable::ShadedTable(const Scene& scene, const TableAxes& axes) : axes_(axes), filter_(scene.table->filter) {
  const Shading* const method = scene.shading->method;
  if (method == nullptr || method->needs_extinction || method->name == "quadratic_arc_fades_printed")
    throw InputError(
        fmt::format("shading {} with a table; methods whose light depends on the normals at both ends of "
                    "a slab only, and is seen through moments of matter or white, are allowed",
                    method == nullptr ? "pointwise" : method->name));
  check(axes);
  if (axes.size > largest_size)
    throw InputError(
        fmt::format("found a shaded table of {} entries per axis; 2 to {} are allowed", axes.size, largest_size));
  entries_.resize(axes.size * axes.size);
  if (scene.table->builder == "exact")
    integrate_entries(scene);
  else if (scene.table->builder == "subrange_means")
    make_by_subranges(scene);
  else
    throw InputError(
        fmt::format("table builder {} with shading; exact and subrange_means are allowed", scene.table->builder));
  for (Entry& entry : entries_)
    for (double& number : entry) number = stored(scene.table->format, number);
}

void ShadedTable::integrate_entries(const Scene& scene) {
  const PiecewiseLinear transfer = linear_in_extinction(scene.transfer);
  tbb::parallel_for(std::size_t{0}, axes_.size, [&](std::size_t back) {
    for (std::size_t front = 0; front < axes_.size; ++front) {
      const SlabOptics optics(transfer, axes_.scalar(front), axes_.scalar(back), axes_.length);
      const SlabMoments moments = slab_moments(optics, scene.emission);
      Entry& entry = at(front, back);
      for (Eigen::Index k = 0; k < powers; ++k) {
        entry.segment<3>(4 * k) = moments.colored[static_cast<std::size_t>(k)];
        entry[4 * k + 3] = moments.white[static_cast<std::size_t>(k)];
      }
      entry[tent] = moments.white[powers];
      entry[opacity] = optics.opacity();
    }
  });
}

void ShadedTable::make_by_subranges(const Scene& scene) {
  const MomentTables tables = moment_tables(interval_means(scene.transfer, axes_, scene.emission), axes_);
  for (std::size_t back = 0; back < axes_.size; ++back)
    for (std::size_t front = 0; front < axes_.size; ++front) {
      Entry& entry = at(front, back);
      for (Eigen::Index k = 0; k < powers; ++k)
        entry.segment<4>(4 * k) = tables.moments[static_cast<std::size_t>(k)].at(front, back);
      entry[tent] = tables.tent.at(front, back)[0];
      entry[opacity] = tables.tent.at(front, back)[3];
    }
}

ShadedTable::Entry ShadedTable::look_up(double front, double back) const {
  const auto f = TablePlace<double>::of(axes_, front, 0);
  const auto b = TablePlace<double>::of(axes_, back, 0);
  if (filter_ == TableFilter::nearest) return at(f.nearest(), b.nearest());
  const auto row = [&](std::size_t which) -> Entry {
    return at(f.first, which) + f.weight * (at(f.second, which) - at(f.first, which));
  };
  const Entry first = row(b.first);
  return first + b.weight * (row(b.second) - first);
}

Eigen::Array4d ShadedTable::operator()(double front, double back, double share, const SlabShader& shader,
                                       const LightModel& model) const {
  const Entry slab = look_up(front, back);
  Eigen::Matrix<double, 4, 4> values;  // matter and white light at four points
  for (int i = 0; i < 4; ++i) {
    const LitPoint point = shader.at(i / 3.0, 0);
    const PointLight light = model(point.diffuse, point.specular);
    values.row(i) << light.matter, light.white.matrix().transpose();
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
  if (share == 1) return result;
  Rules<double> rules;
  return rules.opacity_corrected_slab(result, rules.opacity_correction(slab[opacity], share), share);
}

}  // namespace raytruth
