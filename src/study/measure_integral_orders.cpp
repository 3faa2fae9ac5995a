#include "measures/order.hpp"
#include "study/error_summary.hpp"
#include "study/measure.hpp"
#include "study/ray_study.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace raytruth {

namespace {

// Errors closer than this to the reference's radius take no part in a fit.
constexpr double meaningful_radii = 10;

constexpr int coarsest = 3;
constexpr int finest = 8;
constexpr std::size_t level_count = finest - coarsest + 1;

double step_of(std::size_t level) { return std::ldexp(1.0, -coarsest - static_cast<int>(level)); }

/// How samples get closer: inside every cell alike, so that no interval crosses a border, or along the whole ray.
enum class Regime { cells, constant };

constexpr std::array regimes{std::pair{Regime::cells, "cells"}, std::pair{Regime::constant, "constant"}};

void sample(const Chain<3>& signal, Regime regime, std::size_t level, Samples<double>& samples) {
  if (regime == Regime::cells)
    sample_cells(signal, samples, 1 << (coarsest + static_cast<int>(level)));
  else
    sample_constant(signal, step_of(level), samples);
}

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

void add_fit(Row& row, const std::string& name, const Convergence& convergence, double (*rms)(const RayErrors&)) {
  std::vector<StepError> points;
  for (std::size_t level = 0; level < level_count; ++level) {
    const RayErrors& errors = convergence.levels[level];
    if (rms(errors) > meaningful_radii * errors.radius) points.push_back({step_of(level), rms(errors)});
  }
  const bool is_fit = points.size() >= 2;
  const FittedOrder fit = is_fit ? fit_order(points) : FittedOrder{};
  row.emplace_back("order_" + name, is_fit ? Value(fit.order) : Value());
  row.emplace_back("order_" + name + "_residual", is_fit ? Value(fit.residual) : Value());
  row.emplace_back("order_" + name + "_finest", is_fit ? Value(points.back().step) : Value());
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
  add_fit(row, "opacity", convergence, rms_opacity);
  add_fit(row, "color", convergence, rms_color);
}

}  // namespace

std::vector<Column> integral_orders_columns(const Experiment& experiment, const JsonReader& options) {
  options.only({"kind"});
  need_schemes(experiment);
  need_transfers(experiment);
  std::vector<Column> columns = transfer_columns();
  columns.insert(
      columns.end(),
      {{.name = "regime",
        .unit = "",
        .description = "cells: every cell divided alike, no interval crosses a border; constant: a constant step",
        .is_key = true},
       {.name = "scheme", .unit = "", .description = "the scheme", .is_key = true},
       {.name = "part", .unit = "", .description = "point: errors at one step; fit: the orders", .is_key = true},
       {.name = "step", .unit = "cell or voxel", .description = "distance of samples", .is_key = true}});
  for (const std::string name : {"opacity", "color"})
    columns.push_back({.name = name + "_rms",
                       .unit = "",
                       .description = "root mean square of the " + name + "'s error over rays" +
                                      (name == "color" ? " and channels" : ""),
                       .is_key = false,
                       .radius = "radius"});
  columns.push_back({.name = "radius", .unit = "", .description = "bound on the error of the errors: the reference's"});
  for (const std::string name : {"opacity", "color"}) {
    columns.push_back(
        {.name = "order_" + name,
         .unit = "",
         .description = fmt::format("slope of log {}_rms over log step, least squares over steps 2^-{} to "
                                    "2^-{}, without points within {} radii",
                                    name, coarsest, finest, meaningful_radii)});
    columns.push_back({.name = "order_" + name + "_residual",
                       .unit = "",
                       .description = "root mean square of log2 of the errors about the line"});
    columns.push_back(
        {.name = "order_" + name + "_finest", .unit = "cell or voxel", .description = "least step in the fit"});
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
        keys.insert(keys.end(), {{"regime", name}, {"scheme", experiment.schemes[scheme]}});
        add_rows(keys, convergences[scheme], rows);
      }
    }
  return rows;
}

}  // namespace raytruth
