#include "experiments/measure.hpp"
#include "measures/convergence.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/reference/certified.hpp"

#include <array>

namespace raytruth {

namespace {

/// Errors of one scheme by level, or why there are none.
struct Convergence {
  std::array<RayErrors, level_count> levels;
  std::string_view refusal;
};

/// By scheme.
std::vector<Convergence> converge(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer,
                                  Regime regime) {
  const auto schemes = schemes_of(experiment);
  using OfRay = std::vector<std::array<Outcome<>, level_count>>;
  std::vector<OfRay> rays(static_cast<std::size_t>(experiment.rays.count));
  std::vector<Certified> truths(rays.size());
  study_rays(experiment, field, transfer, [&](const StudiedRay& ray) {
    Samples<double> samples;
    truths[ray.index] = ray.truth;
    rays[ray.index].resize(schemes.size());
    for (std::size_t level = 0; level < level_count; ++level) {
      sample(ray.signal, regime, level, samples);
      for (std::size_t scheme = 0; scheme < schemes.size(); ++scheme)
        rays[ray.index][scheme][level] = ray.integrate(*schemes[scheme], ray.signal, samples);
    }
  });
  std::vector<Convergence> convergences(schemes.size());
  for (std::size_t ray = 0; ray < rays.size(); ++ray)
    for (std::size_t scheme = 0; scheme < rays[ray].size(); ++scheme)
      for (std::size_t level = 0; level < level_count; ++level) {
        const Outcome<>& outcome = rays[ray][scheme][level];
        const Certified& truth = truths[ray];
        if (outcome.refusal.empty())
          convergences[scheme].levels[level].add({outcome.color - truth.color, outcome.opacity - truth.opacity},
                                                 outcome.radius + truth.radius);
        else
          convergences[scheme].refusal = outcome.refusal;
      }
  return convergences;
}

std::array<LevelError, level_count> levels_of(const Convergence& convergence, double (*rms)(const RayErrors&)) {
  std::array<LevelError, level_count> levels;
  for (std::size_t level = 0; level < level_count; ++level)
    levels[level] = {rms(convergence.levels[level]), convergence.levels[level].radius};
  return levels;
}

void add_rows(const Row& keys, const Convergence& convergence, std::vector<Row>& rows) {
  if (!convergence.refusal.empty()) {
    Row& row = rows.emplace_back(keys);
    row.insert(row.end(), {{"part", "fit"}, {"status", "refused"}, {"why", std::string(convergence.refusal)}});
    return;
  }
  for (std::size_t level = 0; level < level_count; ++level) {
    const RayErrors& errors = convergence.levels[level];
    Row& row = rows.emplace_back(keys);
    row.insert(row.end(), {{"part", "point"},
                           {"step", step_of(level)},
                           {"opacity_rms", rms_opacity(errors)},
                           {"color_rms", rms_color(errors)},
                           {"radius", errors.radius}});
  }
  Row& row = rows.emplace_back(keys);
  row.emplace_back("part", "fit");
  add_order(row, "opacity", levels_of(convergence, rms_opacity));
  add_order(row, "color", levels_of(convergence, rms_color));
}

}  // namespace

std::vector<Column> integral_orders_columns(const Experiment& experiment, const JsonReader& options) {
  options.only({"kind"});
  need_schemes(experiment);
  need_transfers(experiment);
  std::vector<Column> columns = transfer_columns();
  const std::vector<Column> keys = convergence_columns();
  columns.insert(columns.end(), keys.begin(), keys.end());
  for (const std::string name : {"opacity", "color"})
    columns.push_back({.name = name + "_rms",
                       .unit = "",
                       .description = "root mean square of the " + name + "'s error over rays" +
                                      (name == "color" ? " and channels" : ""),
                       .is_key = false,
                       .radius = "radius"});
  columns.push_back({.name = "radius", .unit = "", .description = "bound on the error of the errors: the reference's"});
  for (const std::string name : {"opacity", "color"}) {
    const std::vector<Column> of_order = order_columns(name, name + "_rms");
    columns.insert(columns.end(), of_order.begin(), of_order.end());
  }
  return columns;
}

std::vector<Row> integral_orders_rows(const Experiment& experiment, const JsonReader& /*options*/, const Field& field) {
  std::vector<Row> rows;
  for (const NamedTransfer& transfer : experiment.transfers)
    for (const auto& [regime, name] : regimes) {
      const auto convergences = converge(experiment, field, transfer.transfer, regime);
      for (std::size_t scheme = 0; scheme < convergences.size(); ++scheme) {
        Row keys = transfer_keys(experiment, transfer);
        keys.insert(keys.end(), {{"regime", std::string(name)}, {"scheme", experiment.schemes[scheme]}});
        add_rows(keys, convergences[scheme], rows);
      }
    }
  return rows;
}

}  // namespace raytruth
