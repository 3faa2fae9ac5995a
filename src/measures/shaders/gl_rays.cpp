#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/gl/rule_shader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

/// A ray by a sampled scheme, in three arithmetics, and what the fourth begins with.
struct MarchedRay {
  Certified truth;
  SampledRay<Binary32> ray;
  TwinValues<Real50> in_50_digits;
  TwinValues<double> in_binary64;
  TwinValues<double> in_binary32;
};

template <class Real>
TwinValues<Real> values_of(const Outcome<Real>& outcome) {
  return {outcome.color[0], outcome.color[1], outcome.color[2], outcome.opacity};
}

/// By ray; none for rays with a constant signal.
std::vector<std::optional<MarchedRay>> march_rays(const Experiment& experiment, const Field& field,
                                                  const PiecewiseLinear& transfer, const Sampling& sampling,
                                                  const Sampled& method) {
  const OpticsLookup<Real50> look_up_in_50_digits(transfer, experiment.emission);
  const OpticsLookup<double> look_up(transfer, experiment.emission);
  const OpticsLookup<Binary32> look_up_in_binary32(transfer, experiment.emission);
  std::vector<std::optional<MarchedRay>> rays(static_cast<std::size_t>(experiment.rays.count));
  study_rays(experiment, field, transfer, [&](const StudiedRay& ray) {
    Samples<double> samples;
    sample(ray.signal, sampling, samples);
    const SampledRay<Binary32> binary32(ray.signal, samples);
    const auto low = values_of(march(method, look_up_in_binary32, binary32));
    rays[ray.index] = MarchedRay{
        .truth = ray.truth,
        .ray = binary32,
        .in_50_digits = values_of(march(method, look_up_in_50_digits, SampledRay<Real50>(ray.signal, samples))),
        .in_binary64 = values_of(march(method, look_up, SampledRay<double>(ray.signal, samples))),
        .in_binary32 = {to_double(low[0]), to_double(low[1]), to_double(low[2]), to_double(low[3])}};
  });
  return rays;
}

/// The errors of a scheme over rays, step by step from the truth to the shader.
struct Budget {
  RayErrors method;   ///< the scheme in 50 digits - the truth
  RayErrors round64;  ///< in binary64 - in 50 digits
  RayErrors round32;  ///< in binary32 - in binary64
  RayErrors gl;       ///< in GLSL - in binary32
  RayErrors total;    ///< in GLSL - the truth
};

struct Term {
  const char* name;
  RayErrors Budget::*errors;
};

constexpr std::array terms{
    Term{"method", &Budget::method}, Term{"round64", &Budget::round64}, Term{"round32", &Budget::round32},
    Term{"gl", &Budget::gl},         Term{"total", &Budget::total},
};

Difference difference(const std::array<double, 4>& values) {
  return {Vector3<double>(values[0], values[1], values[2]), values[3]};
}

void add(Budget& budget, const MarchedRay& ray, const TwinValues<float>& shader) {
  const TwinValues<double> truth{ray.truth.color[0], ray.truth.color[1], ray.truth.color[2], ray.truth.opacity};
  std::array<std::array<double, 4>, terms.size()> differences{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double gl = shader[i];
    differences[0][i] = to_double(ray.in_50_digits[i] - Real50(truth[i]));
    differences[1][i] = to_double(Real50(ray.in_binary64[i]) - ray.in_50_digits[i]);
    differences[2][i] = ray.in_binary32[i] - ray.in_binary64[i];
    differences[3][i] = gl - ray.in_binary32[i];
    differences[4][i] = gl - truth[i];
  }
  for (std::size_t term = 0; term < terms.size(); ++term) {
    const bool has_reference = term == 0 || term + 1 == terms.size();
    (budget.*terms[term].errors).add(difference(differences[term]), has_reference ? ray.truth.radius : 0);
  }
}

const Sampled& method_of(const IntegralScheme& scheme) { return std::get<Sampled>(scheme.method); }

void need_sampled_schemes(const Experiment& experiment) {
  std::vector<std::string_view> names;
  for (const IntegralScheme& scheme : catalogue::integral_schemes())
    if (std::holds_alternative<Sampled>(scheme.method)) names.push_back(scheme.name);
  for (const JsonReader& scheme : experiment.json.at("schemes").items()) scheme.word(names);
}

void need_steps_of_virtual_samples(const Experiment& experiment) {
  const auto schemes = schemes_of(experiment);
  const bool are_virtual = std::any_of(schemes.begin(), schemes.end(), [](const IntegralScheme* scheme) {
    return method_of(*scheme).rule == SampledRule::virtual_catmull_rom;
  });
  for (std::size_t i = 0; i < experiment.samplings.size() && are_virtual; ++i)
    if (!experiment.samplings[i].step)
      experiment.json.at("samplings").items()[i].refuse_value("a constant step for virtual samples");
}

struct Options {};

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind"});
  need_sampled_schemes(experiment);
  need_steps_of_virtual_samples(experiment);
  return {};
}

/// The errors that one step from the truth to the shader adds.
struct Record {
  TransferKeys transfer;
  Sampling sampling;
  std::string_view scheme;
  std::string_view term;
  RayCounts rays;
  ErrorSummary errors;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::transfer, transfer_key_columns());
  append_part(columns, &Record::sampling, sampling_key_columns());
  columns.push_back({.name = "scheme", .description = "the scheme", .is_key = true, .cell = &Record::scheme});
  columns.push_back({.name = "term",
                     .description =
                         "method: the scheme in 50 digits - the truth; round64: in binary64 - in 50 digits; "
                         "round32: in binary32 - in binary64; gl: in GLSL - in binary32; total: in GLSL - the "
                         "truth, their sum",
                     .is_key = true,
                     .cell = &Record::term});
  append_part(columns, &Record::rays, ray_count_columns());
  append_part(columns, &Record::errors, error_summary_columns("", "this term"));
  return columns;
}

/// The budget of a scheme over the rays of a field, and how many rays it is of.
struct RayBudget {
  Budget budget;
  std::size_t rays = 0;
};

RayBudget budget_of(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer,
                    const Sampling& sampling, const Sampled& method, GlDevice& device) {
  const auto marched = march_rays(experiment, field, transfer, sampling, method);
  std::vector<SampledRay<Binary32>> inputs;
  for (const auto& ray : marched)
    if (ray) inputs.push_back(ray->ray);
  const auto shown = run_march(device, method, transfer, experiment.emission, inputs);
  RayBudget result;
  for (const auto& ray : marched)
    if (ray) add(result.budget, *ray, shown[result.rays++]);
  return result;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  const auto device = open_gl(experiment.gl);
  std::vector<Record> records;
  for (const NamedTransfer& transfer : experiment.transfers)
    for (const Sampling& sampling : experiment.samplings)
      for (const IntegralScheme* scheme : schemes_of(experiment)) {
        const auto [budget, rays] =
            budget_of(experiment, field, transfer.transfer, sampling, method_of(*scheme), *device);
        for (const auto& [name, errors] : terms)
          records.push_back({.transfer = {transfer.name, experiment.emission},
                             .sampling = sampling,
                             .scheme = scheme->name,
                             .term = name,
                             .rays = ray_counts(experiment, rays),
                             .errors = summary_of(budget.*errors)});
      }
  return records;
}

}  // namespace

extern const Measure gl_rays_measure;
const Measure gl_rays_measure{MeasureDefinition<Options, Record>{
    .name = "gl_rays",
    .summary = "errors of rays in a shader: of the method, and of each arithmetic down to GLSL",
    .uses_gl = true,
    .needs = {.schemes = true, .transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
