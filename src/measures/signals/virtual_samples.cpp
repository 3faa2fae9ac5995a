#include "experiments/measure.hpp"
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
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

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

/// Of one method.
struct Errors {
  SampleError all;
  SampleError between;  ///< true samples, that is where virtual ones are

  Errors& operator+=(const Errors& other) {
    all += other.all;
    between += other.between;
    return *this;
  }
};

/// Of all methods, with one reconstruction.
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

Value number_if(bool is_known, double value) { return is_known ? Value(value) : Value(); }

/// `virtual_3` is the error of Cubic x1 + VS x3 at the same samples.
void add_figures(Row& row, const SampleError& error, const SampleError& virtual_3, double radius) {
  const bool has_rmse = error.count > 0;
  const double rmse = error.rmse().value_or(0);
  row.emplace_back("samples", error.count);
  row.emplace_back("rmse", number_if(has_rmse, rmse));
  row.emplace_back("error_max", number_if(has_rmse, error.maximum));
  row.emplace_back("error_radius", radius);

  const bool has_psnr = rmse > radius;
  row.emplace_back("peak", peak);
  row.emplace_back("psnr", number_if(has_psnr, error.psnr(peak).value_or(0)));
  // -ln(1 - x) <= x / (1 - x).
  row.emplace_back("psnr_radius", number_if(has_psnr, 20 / std::numbers::ln10 * radius / (rmse - radius)));
  row.emplace_back("psnr_why", has_psnr ? Value() : has_rmse ? "the RMSE is rounding" : "every ray is constant");

  const double least = virtual_3.rmse().value_or(0);
  const bool has_ratio = has_psnr && least > radius;
  row.emplace_back("rmse_ratio", number_if(has_ratio, rmse / least));
  row.emplace_back("rmse_ratio_radius", number_if(has_ratio, (rmse + least) * radius / (least * (least - radius))));
}

}  // namespace

std::vector<Column> virtual_samples_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  options.only({"kind"});
  return {
      {.name = "reconstruction",
       .unit = "",
       .description =
           "what Cubic and the truth are: the cubic B-spline of the voxels (raw), or through them (prefiltered)",
       .is_key = true},
      {.name = "method",
       .unit = "",
       .description = "Lee's name; x1: samples a voxel apart, held until the next without virtual ones; VS: virtual "
                      "Catmull-Rom samples, LinearVS: on the line; Linear: trilinear",
       .is_key = true},
      {.name = "over",
       .unit = "",
       .description = "the samples compared: all, or virtual, those between the x1 samples",
       .is_key = true},
      {.name = "truth", .unit = "", .description = "what the samples are compared with: Cubic x4 or Cubic x8"},
      {.name = "data_min", .unit = "data", .description = "the field's smallest value, scaled to 0"},
      {.name = "data_max", .unit = "data", .description = "the field's largest value, scaled to 1"},
      {.name = "rays", .unit = "", .description = "rays drawn"},
      {.name = "rays_constant", .unit = "", .description = "of these, rays whose raw spline is constant, left out"},
      {.name = "samples", .unit = "", .description = "samples compared, of all other rays"},
      {.name = "rmse",
       .unit = "scalar",
       .description = "root mean square error",
       .is_key = false,
       .radius = "error_radius"},
      {.name = "error_max",
       .unit = "scalar",
       .description = "largest error",
       .is_key = false,
       .radius = "error_radius"},
      {.name = "error_radius", .unit = "scalar", .description = "bound of the rounding error of rmse and error_max"},
      {.name = "peak", .unit = "scalar", .description = "the peak of psnr: the range of the data, scaled"},
      {.name = "psnr", .unit = "dB", .description = "20 log10(peak / rmse)", .is_key = false, .radius = "psnr_radius"},
      {.name = "psnr_radius", .unit = "dB", .description = "bound of its rounding error"},
      {.name = "psnr_why", .unit = "", .description = "why there is no psnr"},
      {.name = "rmse_ratio",
       .unit = "",
       .description = "rmse over that of Cubic x1 + VS x3 in the same place",
       .is_key = false,
       .radius = "rmse_ratio_radius"},
      {.name = "rmse_ratio_radius", .unit = "", .description = "bound of its rounding error"},
  };
}

std::vector<Row> virtual_samples_rows(const Experiment& experiment, const JsonReader& /*options*/, const Field& field) {
  const Grid prefiltered = bspline_coefficients(field.grid);
  const std::vector<Reconstruction> reconstructions{{"bspline_raw", field.grid}, {"bspline_prefiltered", prefiltered}};
  const Findings findings = measure_rays(experiment, field, reconstructions);

  std::vector<Row> rows;
  for (std::size_t i = 0; i < reconstructions.size(); ++i) {
    const auto& [name, coefficients] = reconstructions[i];
    const double radius = error_radius * largest_magnitude(coefficients);
    const MethodErrors& errors = findings.errors[i];
    for (std::size_t k = 0; k < methods.size(); ++k)
      for (const auto& [over, part] : {std::pair{"all", &Errors::all}, {"virtual", &Errors::between}}) {
        Row& row = rows.emplace_back(Row{{"reconstruction", std::string(name)},
                                         {"method", std::string(methods[k].name)},
                                         {"over", over},
                                         {"truth", methods[k].rate == 4 ? "Cubic x4" : "Cubic x8"},
                                         {"data_min", field.data_range.first},
                                         {"data_max", field.data_range.second},
                                         {"rays", experiment.rays.count},
                                         {"rays_constant", findings.rays_constant}});
        add_figures(row, errors[k].*part, errors.front().*part, radius);
      }
  }
  return rows;
}

}  // namespace raytruth
