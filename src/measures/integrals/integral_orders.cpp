#include "experiments/measure.hpp"
#include "measures/convergence.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/reference/certified.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
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

/// Root mean squares of the errors at one step.
struct StepErrors {
  double opacity_rms = 0;
  double color_rms = 0;
  double radius = 0;
};

/// The orders that all steps show.
struct Orders {
  ShownOrder opacity;
  ShownOrder color;
};

struct Record {
  TransferKeys transfer;
  ConvergenceKeys keys;
  std::optional<StepErrors> errors = {};
  std::optional<Orders> orders = {};
  std::optional<std::string> refusal = {};
};

ShownOrder order_of(const Convergence& convergence, double (*rms)(const RayErrors&)) {
  std::array<LevelError, level_count> levels;
  for (std::size_t level = 0; level < level_count; ++level)
    levels[level] = {rms(convergence.levels[level]), convergence.levels[level].radius};
  return shown_order(levels);
}

/// The errors at every step, and the orders; or why there are none.
void add_records(const TransferKeys& transfer, ConvergenceKeys keys, const Convergence& convergence,
                 std::vector<Record>& records) {
  const auto add = [&]() -> Record& { return records.emplace_back(Record{.transfer = transfer, .keys = keys}); };
  if (!convergence.refusal.empty()) {
    add().refusal = std::string(convergence.refusal);
    return;
  }
  for (std::size_t level = 0; level < level_count; ++level) {
    const RayErrors& errors = convergence.levels[level];
    keys.step = step_of(level);
    add().errors = {.opacity_rms = rms_opacity(errors), .color_rms = rms_color(errors), .radius = errors.radius};
  }
  keys.step.reset();
  add().orders = {.opacity = order_of(convergence, rms_opacity), .color = order_of(convergence, rms_color)};
}

Columns<StepErrors> step_error_columns() {
  return {
      {.name = "opacity_rms",
       .description = "root mean square of the opacity's error over rays",
       .radius = "radius",
       .cell = &StepErrors::opacity_rms},
      {.name = "color_rms",
       .description = "root mean square of the color's error over rays and channels",
       .radius = "radius",
       .cell = &StepErrors::color_rms},
      {.name = "radius",
       .description = "bound on the error of the errors: the reference's",
       .cell = &StepErrors::radius},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::transfer, transfer_key_columns());
  append_part(columns, &Record::keys, convergence_key_columns());
  append_part(columns, &Record::errors, step_error_columns());
  Columns<Orders> of_orders;
  append_part(of_orders, &Orders::opacity, shown_order_columns("opacity", "opacity_rms"));
  append_part(of_orders, &Orders::color, shown_order_columns("color", "color_rms"));
  append_part(columns, &Record::orders, of_orders);
  append_refusal(columns, &Record::refusal);
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  std::vector<Record> records;
  for (const NamedTransfer& transfer : experiment.transfers)
    for (const auto& [regime, name] : regimes) {
      const auto convergences = converge(experiment, field, transfer.transfer, regime);
      for (std::size_t scheme = 0; scheme < convergences.size(); ++scheme)
        add_records({transfer.name, experiment.emission},
                    {.regime = std::string(name), .scheme = experiment.schemes[scheme], .step = {}},
                    convergences[scheme], records);
    }
  return records;
}

}  // namespace

extern const Measure integral_orders_measure;
const Measure integral_orders_measure{MeasureDefinition<Options, Record>{
    .name = "integral_orders",
    .summary = "fitted orders of colour and opacity, refined inside cells and at constant steps",
    .needs = {.schemes = true, .transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
