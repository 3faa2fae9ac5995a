#include "raytruth/render/techniques/shaded_table.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/tables/moments.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace raytruth {

ShadedTable::ShadedTable(const Scene& scene, const TableAxes& axes) : table_(axes), filter_(scene.table->filter) {
  const Shading* const method = scene.shading->method;
  if (method == nullptr || !MomentTable::takes(*method))
    throw InputError(
        fmt::format("shading {} with a table; methods whose light depends on the normals at both ends of "
                    "a slab only, and is seen through moments of matter or white, are allowed",
                    method == nullptr ? "pointwise" : method->name));
  if (scene.table->builder == "exact")
    integrate_entries(scene);
  else if (scene.table->builder == "subrange_means")
    make_by_subranges(scene);
  else
    throw InputError(
        fmt::format("table builder {} with shading; exact and subrange_means are allowed", scene.table->builder));
  for (std::size_t back = 0; back < axes.size; ++back)
    for (std::size_t front = 0; front < axes.size; ++front)
      for (double& number : table_.at(front, back)) number = stored(scene.table->format, number);
}

void ShadedTable::integrate_entries(const Scene& scene) {
  const PiecewiseLinear transfer = linear_in_extinction(scene.transfer);
  const TableAxes& axes = table_.axes();
  tbb::parallel_for(std::size_t{0}, axes.size, [&](std::size_t back) {
    for (std::size_t front = 0; front < axes.size; ++front)
      table_.at(front, back) = MomentTable::entry_of(
          SlabOptics(transfer, axes.scalar(front), axes.scalar(back), axes.length), scene.emission);
  });
}

void ShadedTable::make_by_subranges(const Scene& scene) {
  const TableAxes& axes = table_.axes();
  const MomentTables tables = moment_tables(interval_means(scene.transfer, axes, scene.emission), axes);
  for (std::size_t back = 0; back < axes.size; ++back)
    for (std::size_t front = 0; front < axes.size; ++front) {
      MomentTable::Entry& entry = table_.at(front, back);
      for (Eigen::Index k = 0; k < MomentTable::powers; ++k)
        entry.segment<4>(4 * k) = tables.moments[static_cast<std::size_t>(k)].at(front, back);
      entry[MomentTable::tent] = tables.tent.at(front, back)[0];
      entry[MomentTable::opacity] = tables.tent.at(front, back)[3];
    }
}

Eigen::Array4d ShadedTable::operator()(double front, double back, double share, const SlabLight& light) const {
  const Eigen::Array4d slab = MomentTable::lit(table_.look_up(front, back, filter_ == TableFilter::nearest), light);
  if (share == 1) return slab;
  Rules<double> rules;
  return rules.opacity_corrected_slab(slab, rules.opacity_correction(slab[3], share), share);
}

}  // namespace raytruth
