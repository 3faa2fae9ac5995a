#include "experiments/measure.hpp"
#include "measures/shading/shading_study.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/shading/gooch.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/statistics/statistics.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_slabs = 1'000'000;
constexpr double largest_angle = 170;

struct Options {
  std::vector<double> angles;
  double shininess;
  Emission emission;
  std::int64_t slabs;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "angles", "shininess", "emission", "slabs"});
  Options options{{},
                  json.at("shininess").number(1, largest_shininess),
                  json.at("emission").word({"associated", "plain"}) == "plain" ? Emission::plain : Emission::associated,
                  json.at("slabs").integer(1, most_slabs)};
  for (const JsonReader& angle : json.at("angles").items()) options.angles.push_back(angle.number(0, largest_angle));
  return options;
}

struct SlabTransfer {
  std::string name;
  PiecewiseLinear transfer;
};

/// Optical depths of a slab of length 1 that lies where the extinction is largest: 4, opaque 1000.
std::vector<SlabTransfer> transfers() {
  return {{"ramp", ramp_transfer(4)},
          {"tent", tent_transfer(4)},
          {"step", step_transfer(4)},
          {"opaque", step_transfer(1000)}};
}

Vector3<double> isotropic(double u, double v) {
  const double z = 2 * u - 1;
  const double angle = 2 * std::numbers::pi * v;
  return {std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z};
}

struct LitSlab {
  ShadedSlab slab;
  Lighting lighting;
};

/// Slab `index` of an angle: scalars uniform in [0, 1], light and viewer isotropic.
LitSlab draw(std::uint64_t seed, std::uint64_t index, double angle, double shininess) {
  const auto scalars = random_numbers(seed, RandomStream::cases, index, 0);
  const auto directions = random_numbers(seed, RandomStream::cases, index, 1);
  LitSlab result{studied_slab(angle), {}};
  result.slab.front = scalars[0];
  result.slab.back = scalars[1];
  result.lighting.light = isotropic(directions[0], directions[1]);
  const Vector3<double> sum = result.lighting.light + isotropic(directions[2], directions[3]);
  const double norm = std::sqrt(sum.square().sum());
  result.lighting.half = norm > 0 ? Vector3<double>(sum / norm) : result.lighting.light;
  result.lighting.specular = 1;
  result.lighting.highlight = find_named(catalogue::highlights(), "cone");
  result.lighting.shininess = shininess;
  return result;
}

constexpr std::array<std::string_view, 3> terms{"diffuse", "specular", "gooch"};

/// Signed errors of one slab: [method][term], the channel whose magnitude is largest.
using Errors = std::vector<std::array<double, 3>>;

double largest_channel(const Vector3<double>& error) {
  Eigen::Index channel = 0;
  error.abs().maxCoeff(&channel);
  return error[channel];
}

Errors errors_of(const LitSlab& lit, const PiecewiseLinear& transfer, Emission emission) {
  const auto& [slab, lighting] = lit;
  const CertifiedRadiance truth = slab_reference(slab, transfer, emission, lighting);
  const SlabOptics optics(transfer, slab.front, slab.back, slab.length);
  const SlabCosines c = cosines_of(slab, lighting);
  const auto gooch = [&](const NormalCurve& curve) {
    return gooch_color(optics, emission, curve, c.light_front, c.light_back, c.normals, {});
  };
  const Vector3<double> gooch_truth = gooch(*find_named(catalogue::normal_curves(), "normalized_linear"));
  Errors errors;
  for (const Shading* const shading : studied_shadings()) {
    const ShadedRadiance light = shade(*shading, c, optics, emission, lighting);
    const NormalCurve* const curve = find_named(catalogue::normal_curves(), shading->name);
    errors.push_back({largest_channel(light.diffuse - truth.diffuse), largest_channel(light.specular - truth.specular),
                      curve == nullptr ? 0 : largest_channel(gooch(*curve) - gooch_truth)});
  }
  return errors;
}

/// Below this an error is rounding.
constexpr double smallest_error = 1e-12;

bool is_lit(const Errors& errors, std::size_t term) {
  return std::any_of(errors.begin(), errors.end(),
                     [term](const auto& error) { return std::abs(error[term]) > smallest_error; });
}

/// The errors of a method over the slabs on which any method errs; nothing where there are none.
struct Record {
  std::string transfer;
  double angle = 0;
  std::string_view term;
  const Shading* shading = nullptr;
  std::size_t slabs = 0;
  std::optional<double> mean = {};  ///< of the errors' magnitudes
  std::optional<double> bias = {};
  std::optional<double> p95 = {};      ///< of the errors' magnitudes
  std::optional<double> largest = {};  ///< likewise
  std::optional<double> share_best = {};
  std::optional<double> share_better_than_mean = {};  ///< than mean_gradient
  std::optional<double> share_worse_than_mean = {};
};

void add_records(const std::vector<Errors>& slabs, const std::string& transfer, double angle, std::size_t term,
                 std::vector<Record>& records) {
  const auto shadings = studied_shadings();
  const auto is_measured = [&](std::size_t method) {
    return terms[term] != "gooch" || find_named(catalogue::normal_curves(), shadings[method]->name) != nullptr;
  };
  const auto mean = std::find_if(shadings.begin(), shadings.end(),
                                 [](const Shading* shading) { return shading->name == "mean_gradient"; });
  const auto mean_index = static_cast<std::size_t>(mean - shadings.begin());
  std::vector<const Errors*> lit;
  for (const Errors& errors : slabs)
    if (is_lit(errors, term)) lit.push_back(&errors);
  for (std::size_t method = 0; method < shadings.size(); ++method) {
    if (!is_measured(method)) continue;
    Record& record = records.emplace_back(Record{
        .transfer = transfer, .angle = angle, .term = terms[term], .shading = shadings[method], .slabs = lit.size()});
    if (lit.empty()) continue;
    std::vector<double> magnitudes;
    double sum = 0;
    double signed_sum = 0;
    std::size_t best = 0;
    std::size_t better = 0;
    std::size_t worse = 0;
    for (const Errors* const errors : lit) {
      const double error = (*errors)[method][term];
      const double magnitude = std::abs(error);
      double least = magnitude;
      for (std::size_t other = 0; other < shadings.size(); ++other)
        if (is_measured(other)) least = std::min(least, std::abs((*errors)[other][term]));
      const double of_mean = std::abs((*errors)[mean_index][term]);
      magnitudes.push_back(magnitude);
      sum += magnitude;
      signed_sum += error;
      best += magnitude <= least + smallest_error ? 1 : 0;
      better += magnitude < of_mean - smallest_error ? 1 : 0;
      worse += magnitude > of_mean + smallest_error ? 1 : 0;
    }
    std::sort(magnitudes.begin(), magnitudes.end());
    const auto count = static_cast<double>(lit.size());
    record.mean = sum / count;
    record.bias = signed_sum / count;
    record.p95 = quantile(magnitudes, 0.95);
    record.largest = magnitudes.back();
    record.share_best = static_cast<double>(best) / count;
    record.share_better_than_mean = static_cast<double>(better) / count;
    record.share_worse_than_mean = static_cast<double>(worse) / count;
  }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "transfer_function",
       .description = "transfer function of the slabs",
       .is_key = true,
       .cell = &Record::transfer},
      {.name = "angle_degrees",
       .unit = "degree",
       .description = "full angle between the normals",
       .is_key = true,
       .cell = &Record::angle},
      {.name = "term",
       .description = "diffuse light, the cone's specular light, or Gooch's tones; coefficients are 1",
       .is_key = true,
       .cell = &Record::term},
      {.name = "shading",
       .description = "the method; negative cosines are clamped",
       .is_key = true,
       .cell = [](const Record& record) { return record.shading->name; }},
      {.name = "slabs",
       .description = "of those drawn, on which any method errs by more than 1e-12",
       .cell = &Record::slabs},
      {.name = "error_mean",
       .description = "mean magnitude of the error of a slab's colour, in the channel where it is largest",
       .cell = &Record::mean},
      {.name = "error_signed_mean",
       .description = "mean of the error, method - certified reference",
       .cell = &Record::bias},
      {.name = "error_p95", .description = "95th percentile of the magnitude", .cell = &Record::p95},
      {.name = "error_max", .description = "its maximum", .cell = &Record::largest},
      {.name = "share_best",
       .description = "slabs on which no method's error is smaller by 1e-12",
       .cell = &Record::share_best},
      {.name = "share_better_than_mean",
       .description = "slabs on which the error is smaller than mean_gradient's by 1e-12",
       .cell = &Record::share_better_than_mean},
      {.name = "share_worse_than_mean",
       .description = "slabs on which it is larger by 1e-12",
       .cell = &Record::share_worse_than_mean},
  };
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  for (const auto& [name, transfer] : transfers())
    for (const double angle : options.angles) {
      std::vector<Errors> slabs(static_cast<std::size_t>(options.slabs));
      tbb::parallel_for(std::size_t{0}, slabs.size(), [&, &transfer = transfer](std::size_t i) {
        slabs[i] = errors_of(draw(experiment.seed, i, angle, options.shininess), transfer, options.emission);
      });
      for (std::size_t term = 0; term < terms.size(); ++term) add_records(slabs, name, angle, term, records);
    }
  return records;
}

}  // namespace

extern const Measure shading_integrals_measure;
const Measure shading_integrals_measure{MeasureDefinition<Options, Record>{
    .name = "shading_integrals",
    .summary = "errors of the colour of whole slabs, and the share of slabs a method is best on",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
