#include "experiments/measure.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/metrics/sample_error.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/tricubic.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

// The peak of PSNR: fields are scaled to [0, 1].
constexpr double peak = 1;

// A ray is constant if its signal changes by less than this part of the field's range.
constexpr double smallest_change = 1e-12;

// Rounding of an error, in epsilons of the largest coefficient: 8 for the truth (tests/unit/tricubic_test.cpp), the
// rest for the samples, their cubic and their difference. tests/unit/virtual_samples_test.cpp holds it against 50
// digits.
constexpr double error_radius = 64 * std::numeric_limits<double>::epsilon();

/// A ray's exact signals, and their samples a voxel apart.
struct RaySignals {
  Chain<9> cubic;
  Chain<3> linear;
  Samples<double> cubic_samples;
  Samples<double> linear_samples;
};

template <Scheme S>
void from_cubic(const RaySignals& ray, Chain<3>& approximation) {
  approximate<S>(ray.cubic, ray.cubic_samples, approximation);
}

template <Scheme S>
void from_linear(const RaySignals& ray, Chain<3>& approximation) {
  approximate<S>(ray.linear, ray.linear_samples, approximation);
}

/// A way of having `rate` samples per voxel, compared with as many true samples of the tricubic signal.
struct Method {
  std::string_view name;  ///< Lee's
  int rate;
  void (*approximate)(const RaySignals&, Chain<3>&);
};

constexpr std::array methods{
    Method{"Cubic x1 + VS x3", 4, from_cubic<VirtualCatmullRom3>},
    Method{"Cubic x1 + VS x7", 8, from_cubic<VirtualCatmullRom7>},
    Method{"Cubic x1 + LinearVS x3", 4, from_cubic<VirtualLinear3>},
    Method{"Cubic x1", 4, from_cubic<Order0Left>},
    Method{"Linear x4", 4, [](const RaySignals& ray, Chain<3>& approximation) { approximation = ray.linear; }},
    Method{"Linear x1 + VS x3", 4, from_linear<VirtualCatmullRom3>},
    Method{"Linear x1", 4, from_linear<Order0Left>},
};

struct Reconstruction {
  std::string_view name;
  const Grid& coefficients;
};

/// What one method gives.
struct Errors {
  SampleError all;
  SampleError between;  ///< true samples, that is where virtual ones are

  Errors& operator+=(const Errors& other) {
    all += other.all;
    between += other.between;
    return *this;
  }
};

/// What all methods give, with one reconstruction.
using MethodErrors = std::array<Errors, methods.size()>;

struct Scratch {
  RaySignals ray;
  Samples<double> truth;
  Chain<3> approximation;
};

/// At the samples t = 0, 1/rate, 2/rate, ... before the ray's end: each begins a stretch of the ray.
Errors compare(const Chain<3>& approximation, const Samples<double>& truth, int rate) {
  Errors errors;
  for (std::size_t i = 0; i < truth.interval_count(); ++i) {
    const double difference = approximation.value(truth.positions[i]) - truth.values[i];
    errors.all.add(difference);
    if (i % static_cast<std::size_t>(rate) != 0) errors.between.add(difference);
  }
  return errors;
}

MethodErrors measure_ray(Scratch& scratch) {
  auto& [ray, truth, approximation] = scratch;
  sample_constant(ray.cubic, 1.0, ray.cubic_samples);
  sample_constant(ray.linear, 1.0, ray.linear_samples);
  MethodErrors errors;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const Method& method = methods[i];
    sample_constant(ray.cubic, 1.0 / method.rate, truth);
    method.approximate(ray, approximation);
    errors[i] = compare(approximation, truth, method.rate);
  }
  return errors;
}

bool is_almost_constant(const Chain<9>& signal) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& piece : signal.pieces)
    for (const double coefficient : piece.polynomial.coefficients) {
      low = std::min(low, coefficient);
      high = std::max(high, coefficient);
    }
  return high - low < smallest_change;
}

struct Findings {
  std::vector<MethodErrors> errors;  ///< by reconstruction
  std::int64_t rays_constant = 0;
};

/// The rays are worked on in parallel, each writing to places of its own, which are then added in their order.
Findings measure_rays(const Experiment& experiment, const Field& field,
                      const std::vector<Reconstruction>& reconstructions) {
  const auto count = static_cast<std::size_t>(experiment.rays.count);
  std::vector<std::vector<MethodErrors>> of_rays(count);  // of a constant ray nothing
  tbb::enumerable_thread_specific<Scratch> scratches;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    Scratch& scratch = scratches.local();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Ray ray = random_ray(field.grid, experiment.rays.length, experiment.seed, i);
      trace_tricubic(field.grid, CubicKernel::bspline, ray, scratch.ray.cubic);
      if (is_almost_constant(scratch.ray.cubic)) continue;
      trace_trilinear(field.grid, ray, scratch.ray.linear);
      for (const Reconstruction& reconstruction : reconstructions) {
        trace_tricubic(reconstruction.coefficients, CubicKernel::bspline, ray, scratch.ray.cubic);
        of_rays[i].push_back(measure_ray(scratch));
      }
    }
  });

  Findings findings{std::vector<MethodErrors>(reconstructions.size()), 0};
  for (const auto& of_ray : of_rays) {
    if (of_ray.empty()) ++findings.rays_constant;
    for (std::size_t i = 0; i < of_ray.size(); ++i)
      for (std::size_t k = 0; k < methods.size(); ++k) findings.errors[i][k] += of_ray[i][k];
  }
  return findings;
}

double largest_magnitude(const Grid& grid) {
  const auto [low, high] = grid.range();
  return std::max(std::abs(low), std::abs(high));
}

/// A number and how far it may be from the true one.
struct Bounded {
  double value = 0;
  double radius = 0;
};

/// What a method's errors come to, beside those of Cubic x1 + VS x3 at the same samples.
struct Figures {
  std::int64_t samples = 0;
  std::optional<double> rmse;  ///< none where every ray is constant; so the maximum
  std::optional<double> error_max = {};
  double error_radius = 0;
  std::optional<Bounded> psnr = {};  ///< none where the RMSE is rounding
  std::optional<Bounded> rmse_ratio = {};

  [[nodiscard]] std::optional<std::string_view> why_no_psnr() const {
    if (psnr) return std::nullopt;
    return rmse ? "the RMSE is rounding" : "every ray is constant";
  }
};

/// `virtual_3` is the error of Cubic x1 + VS x3 at the same samples.
Figures figures_of(const SampleError& error, const SampleError& virtual_3, double radius) {
  Figures figures{.samples = error.count, .rmse = error.rmse(), .error_radius = radius};
  if (figures.rmse) figures.error_max = error.maximum;
  const double rmse = figures.rmse.value_or(0);
  if (!(rmse > radius)) return figures;
  // -ln(1 - x) <= x / (1 - x).
  figures.psnr = {error.psnr(peak).value_or(0), 20 / std::numbers::ln10 * radius / (rmse - radius)};
  const double least = virtual_3.rmse().value_or(0);
  if (least > radius) figures.rmse_ratio = {rmse / least, (rmse + least) * radius / (least * (least - radius))};
  return figures;
}

struct Record {
  std::string_view reconstruction;
  const Method* method;
  std::string_view over;
  std::pair<double, double> data_range;
  RayCounts rays;
  Figures figures;
};

/// Null where there is no such figure.
CellOf<Figures> of_figure(std::optional<Bounded> Figures::*figure, double Bounded::*which) {
  return [figure, which](const Figures& figures) {
    const auto& bounded = figures.*figure;
    return bounded ? std::optional((*bounded).*which) : std::nullopt;
  };
}

Columns<Figures> figure_columns() {
  return {
      {.name = "samples", .description = "samples compared, of all other rays", .cell = &Figures::samples},
      {.name = "rmse",
       .unit = "scalar",
       .description = "root mean square error",
       .radius = "error_radius",
       .cell = &Figures::rmse},
      {.name = "error_max",
       .unit = "scalar",
       .description = "largest error",
       .radius = "error_radius",
       .cell = &Figures::error_max},
      {.name = "error_radius",
       .unit = "scalar",
       .description = "bound of the rounding error of rmse and error_max",
       .cell = &Figures::error_radius},
      {.name = "peak",
       .unit = "scalar",
       .description = "the peak of psnr: the range of the data, scaled",
       .cell = [](const Figures& /*figures*/) { return peak; }},
      {.name = "psnr",
       .unit = "dB",
       .description = "20 log10(peak / rmse)",
       .radius = "psnr_radius",
       .cell = of_figure(&Figures::psnr, &Bounded::value)},
      {.name = "psnr_radius",
       .unit = "dB",
       .description = "bound of its rounding error",
       .cell = of_figure(&Figures::psnr, &Bounded::radius)},
      {.name = "psnr_why", .description = "why there is no psnr", .cell = &Figures::why_no_psnr},
      {.name = "rmse_ratio",
       .description = "rmse over that of Cubic x1 + VS x3 in the same place",
       .radius = "rmse_ratio_radius",
       .cell = of_figure(&Figures::rmse_ratio, &Bounded::value)},
      {.name = "rmse_ratio_radius",
       .description = "bound of its rounding error",
       .cell = of_figure(&Figures::rmse_ratio, &Bounded::radius)},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "reconstruction",
       .description =
           "what Cubic and the truth are: the cubic B-spline of the voxels (raw), or through them (prefiltered)",
       .is_key = true,
       .cell = &Record::reconstruction},
      {.name = "method",
       .description = "Lee's name; x1: samples a voxel apart, held until the next without virtual ones; VS: virtual "
                      "Catmull-Rom samples, LinearVS: on the line; Linear: trilinear",
       .is_key = true,
       .cell = [](const Record& record) { return record.method->name; }},
      {.name = "over",
       .description = "the samples compared: all, or virtual, those between the x1 samples",
       .is_key = true,
       .cell = &Record::over},
      {.name = "truth",
       .description = "what the samples are compared with: Cubic x4 or Cubic x8",
       .cell = [](const Record& record) { return record.method->rate == 4 ? "Cubic x4" : "Cubic x8"; }},
      {.name = "data_min",
       .unit = "data",
       .description = "the field's smallest value, scaled to 0",
       .cell = [](const Record& record) { return record.data_range.first; }},
      {.name = "data_max",
       .unit = "data",
       .description = "the field's largest value, scaled to 1",
       .cell = [](const Record& record) { return record.data_range.second; }},
      {.name = "rays", .description = "rays drawn", .cell = [](const Record& record) { return record.rays.drawn; }},
      {.name = "rays_constant",
       .description = "of these, rays whose raw spline is constant, left out",
       .cell = [](const Record& record) { return record.rays.constant; }},
  };
  append_part(columns, &Record::figures, figure_columns());
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  const Grid prefiltered = bspline_coefficients(field.grid);
  const std::vector<Reconstruction> reconstructions{{"bspline_raw", field.grid}, {"bspline_prefiltered", prefiltered}};
  const Findings findings = measure_rays(experiment, field, reconstructions);

  std::vector<Record> records;
  for (std::size_t i = 0; i < reconstructions.size(); ++i) {
    const auto& [name, coefficients] = reconstructions[i];
    const double radius = error_radius * largest_magnitude(coefficients);
    const MethodErrors& errors = findings.errors[i];
    for (std::size_t k = 0; k < methods.size(); ++k)
      for (const auto& [over, part] : {std::pair{"all", &Errors::all}, {"virtual", &Errors::between}})
        records.push_back({.reconstruction = name,
                           .method = &methods[k],
                           .over = over,
                           .data_range = field.data_range,
                           .rays = {experiment.rays.count, findings.rays_constant},
                           .figures = figures_of(errors[k].*part, errors.front().*part, radius)});
  }
  return records;
}

}  // namespace

extern const Measure virtual_samples_measure;
const Measure virtual_samples_measure{MeasureDefinition<Options, Record>{
    .name = "virtual_samples",
    .summary = "RMSE, maximum and PSNR of virtual samples, and of fewer or trilinear ones",
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
