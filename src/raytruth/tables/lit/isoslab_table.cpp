#include "raytruth/tables/lit/isoslab_table.hpp"

#include "raytruth/rules/rules.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdint>
#include <optional>

namespace raytruth {

namespace {

/// Nothing but the surfaces' own colours.
SlabLight unlit() {
  return {.shader = {.at = [](double /*x*/, double /*slope*/) { return LitPoint{}; }},
          .model = LightModel({.ambient = 1, .diffuse = 0}, std::nullopt, SpecularDensity::white)};
}

}  // namespace

IsoslabTable::IsoslabTable(const std::vector<Isosurface>& surfaces, IsoslabDensity density, const Isoslab& isoslab,
                           const TableAxes& axes)
    : is_per_crossing_(density == IsoslabDensity::per_crossing), table_(axes) {
  const double entry = (axes.high - axes.low) / static_cast<double>(axes.size - 1);
  const PiecewiseLinear transfer =
      isoslab_transfer(surfaces, isoslab.width * entry, is_per_crossing_ ? 1 : isoslab.slope);
  tbb::parallel_for(std::size_t{0}, axes.size, [&](std::size_t back) {
    for (std::size_t front = 0; front < axes.size; ++front) {
      const double s_front = axes.scalar(front);
      const double s_back = axes.scalar(back);
      // Per crossing the way is one through scalars.
      const double way = is_per_crossing_ ? std::abs(s_back - s_front) : axes.length;
      if (way > 0)
        table_.at(front, back) =
            MomentTable::entry_of(SlabOptics(transfer, s_front, s_back, way), Emission::associated);
    }
  });
}

Eigen::Array4d IsoslabTable::operator()(double front, double back, double length, const SlabLight& light) const {
  const Eigen::Array4d slab = MomentTable::lit(table_.look_up(front, back), light);
  const double share = length / table_.axes().length;
  if (is_per_crossing_ || share == 1) return slab;
  Rules<double> rules;
  return rules.opacity_corrected_slab(slab, rules.opacity_correction(slab[3], share), share);
}

Outcome<> isoslab_light(const IsoslabTable& table, const Samples<double>& samples,
                        const std::function<SlabLight(double begin, double end)>& light_of) {
  const SlabLight own = unlit();
  Rules<double> rules;
  Rules<double>::vec4 ray = Rules<double>::vec4::Zero();
  const std::size_t full = full_intervals(samples);
  for (std::size_t k = 0; k < samples.interval_count(); ++k) {
    const auto begin = static_cast<double>(samples.positions[k]);
    const auto end = static_cast<double>(samples.positions[k + 1]);
    const double length = k < full && samples.step ? *samples.step : samples.length_of(k);
    const SlabLight light = light_of ? light_of(begin, end) : own;
    ray = rules.over(ray, table(samples.values[k], samples.values[k + 1], length, light));
  }
  Outcome<> outcome;
  outcome.color = ray.head<3>();
  outcome.opacity = ray[3];
  outcome.fetches = static_cast<std::int64_t>(samples.values.size());
  outcome.voxels = voxels_per_fetch * outcome.fetches;
  outcome.lookups = outcome.composites = static_cast<std::int64_t>(samples.interval_count());
  return outcome;
}

}  // namespace raytruth
