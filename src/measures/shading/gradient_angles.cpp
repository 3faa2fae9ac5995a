#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/metrics/slab_extremes.hpp"
#include "raytruth/shading/highlight.hpp"
#include "raytruth/shading/normal_curve.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/statistics/proportion.hpp"
#include "raytruth/statistics/statistics.hpp"
#include "raytruth/volume/gradient.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

/// Below it a gradient is nothing but noise and has no direction: range of the data per voxel.
constexpr double least_gradient = 1e-3;
constexpr double smallest_step = 1.0 / 16;

/// Angles, in degrees, whose shares are counted.
constexpr std::array counted_angles{60, 90};

/// What follows from an angle is told of these curves, at these percentiles of the angle.
constexpr std::array<std::string_view, 4> curves{"mean_gradient", "linear_gradient", "quadratic_arc", "minimax_arc"};
constexpr std::array error_percents{50, 95};

struct Options {
  std::vector<double> steps;
};

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "steps"});
  Options options;
  for (const JsonReader& step : json.at("steps").items())
    options.steps.push_back(step.number(smallest_step, experiment.rays.length));
  return options;
}

/// The consecutive samples of a ray.
struct RayAngles {
  std::vector<double> angles;  ///< degrees, of pairs whose gradients both have a direction
  std::int64_t excluded = 0;
};

double angle_between(const Vector3<double>& first, const Vector3<double>& second) {
  // For unit vectors; accurate for small angles too (W. Kahan, How futile are mindless assessments of roundoff, 2006).
  return 2 * std::atan2((first - second).matrix().norm(), (first + second).matrix().norm()) * 180 /
         boost::math::constants::pi<double>();
}

RayAngles angles_along(const Grid& grid, const GradientFilter& filter, const Ray& ray, double step) {
  const std::array<double, 3> direction = unit_direction(ray.direction);
  RayAngles result;
  Gradient before;
  for (std::int64_t i = 0; static_cast<double>(i) * step <= ray.length * (1 + 1e-9); ++i) {
    const double t = static_cast<double>(i) * step;
    const Gradient here = gradient_at(
        grid, filter,
        {ray.origin[0] + t * direction[0], ray.origin[1] + t * direction[1], ray.origin[2] + t * direction[2]});
    const auto has_direction = [](const Gradient& gradient) {
      return gradient.raw.matrix().norm() > least_gradient && gradient.normal.matrix().norm() > 0;
    };
    if (i > 0) {
      if (has_direction(before) && has_direction(here))
        result.angles.push_back(angle_between(before.normal, here.normal));
      else
        ++result.excluded;
    }
    before = here;
  }
  return result;
}

/// An error that follows from the normals by a curve and by the linear interpolation, normalised, at a point of a slab.
struct NormalError {
  std::string_view name;
  std::string_view description;
  double (*error)(const PlaneVector<double>& normal, const PlaneVector<double>& reference);
};

double lobe_on_bisector(const PlaneVector<double>& normal) {
  constexpr double shininess = 20;
  return find_named(catalogue::highlights(), "lobe")->value(normal.bisector, shininess);
}

constexpr std::array normal_errors{
    NormalError{"error", "largest error of N.L over the slab and all lights (eta: distance_linear_max)",
                between<double>},
    NormalError{"lobe_error",
                "largest error over the slab of a lobe with n = 20 whose half vector is on the normals' bisector "
                "(slab_shading: error_max)",
                [](const PlaneVector<double>& normal, const PlaneVector<double>& reference) {
                  return std::abs(lobe_on_bisector(normal) - lobe_on_bisector(reference));
                }}};

/// Over the slab; none where the curve is singular.
std::optional<double> largest_error(const NormalError& of, std::string_view curve_name, double angle) {
  const double cosine = std::cos(angle * boost::math::constants::pi<double>() / 180);
  const NormalCurve& curve = *find_named(catalogue::normal_curves(), curve_name);
  const NormalCurve& reference = *find_named(catalogue::normal_curves(), "normalized_linear");
  const double error = largest_over_slab<double>([&](double s) {
                         return of.error(normal_at(curve, s, cosine), normal_at(reference, s, cosine));
                       }).second;
  return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

/// The angles of all pairs along the rays of a field whose gradients have a direction.
struct PairAngles {
  std::array<Proportion, counted_angles.size()> above;  ///< each of the counted angles
  ShownQuantiles quantiles;
  double largest = 0;
  /// Over the slab, none where the curve is singular, of each of `normal_errors`, `curves` and `error_percents`.
  std::array<std::array<std::array<std::optional<double>, error_percents.size()>, curves.size()>, normal_errors.size()>
      errors;
};

/// Counts of rays with one such pair at least.
PairAngles pair_angles(const std::vector<RayAngles>& rays) {
  PairAngles result;
  for (std::size_t i = 0; i < counted_angles.size(); ++i) {
    std::vector<Cluster> clusters;
    for (const RayAngles& ray : rays)
      clusters.push_back({.hits = std::count_if(ray.angles.begin(), ray.angles.end(),
                                                [i](double of_pair) { return of_pair > counted_angles[i]; }),
                          .trials = static_cast<std::int64_t>(ray.angles.size())});
    result.above[i] = clustered_proportion(clusters);
  }
  std::vector<double> angles;
  for (const RayAngles& ray : rays) angles.insert(angles.end(), ray.angles.begin(), ray.angles.end());
  std::sort(angles.begin(), angles.end());
  result.quantiles = shown_quantiles(angles);
  result.largest = angles.back();
  for (std::size_t error = 0; error < normal_errors.size(); ++error)
    for (std::size_t curve = 0; curve < curves.size(); ++curve)
      for (std::size_t i = 0; i < error_percents.size(); ++i)
        result.errors[error][curve][i] =
            largest_error(normal_errors[error], curves[curve], quantile(angles, error_percents[i] / 100.0));
  return result;
}

/// The consecutive samples along the rays of a field.
struct Record {
  const GradientFilter* gradient = nullptr;
  double step = 0;
  std::int64_t pairs = 0;
  std::int64_t excluded = 0;         ///< of the pairs
  std::optional<PairAngles> angles;  ///< none where all pairs are excluded
};

Columns<PairAngles> angle_columns() {
  Columns<PairAngles> columns;
  for (std::size_t i = 0; i < counted_angles.size(); ++i) {
    const std::string name = fmt::format("above_{}", counted_angles[i]);
    append(columns,
           {{.name = name,
             .description = fmt::format("share of the other pairs with an angle above {} degrees", counted_angles[i]),
             .cell = [i](const PairAngles& angles) { return angles.above[i].estimate; }},
            {.name = name + "_low",
             .description = "95 % interval, clustered by ray",
             .cell = [i](const PairAngles& angles) { return angles.above[i].low; }},
            {.name = name + "_high",
             .description = "95 % interval, clustered by ray",
             .cell = [i](const PairAngles& angles) { return angles.above[i].high; }}});
  }
  append_part(columns, &PairAngles::quantiles,
              shown_quantile_columns("angle", "degree", "angle between the normals of two consecutive samples"));
  columns.push_back(
      {.name = "angle_max", .unit = "degree", .description = "largest of these angles", .cell = &PairAngles::largest});
  for (std::size_t error = 0; error < normal_errors.size(); ++error)
    for (std::size_t curve = 0; curve < curves.size(); ++curve)
      for (std::size_t i = 0; i < error_percents.size(); ++i)
        columns.push_back(
            {.name = fmt::format("{}_{}_p{}", curves[curve], normal_errors[error].name, error_percents[i]),
             .description = fmt::format("by {} at angle_p{}: {}; null: singular", curves[curve], error_percents[i],
                                        normal_errors[error].description),
             .cell = [=](const PairAngles& angles) { return angles.errors[error][curve][i]; }});
  return columns;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "gradient",
       .description = "how gradients are taken at voxels",
       .is_key = true,
       .cell = [](const Record& record) { return record.gradient->name; }},
      {.name = "step", .unit = "voxel", .description = "distance of samples", .is_key = true, .cell = &Record::step},
      {.name = "pairs", .description = "consecutive samples along rays", .cell = &Record::pairs},
      {.name = "excluded_share",
       .description = "share of pairs left out: a gradient of at most 1e-3 range/voxel has no direction",
       .cell =
           [](const Record& record) {
             return static_cast<double>(record.excluded) / static_cast<double>(record.pairs);
           }},
  };
  append_part(columns, &Record::angles, angle_columns());
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  std::vector<Record> records;
  for (const double step : options.steps)
    for (const GradientFilter& filter : catalogue::gradient_filters()) {
      std::vector<RayAngles> rays(static_cast<std::size_t>(experiment.rays.count));
      tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t ray) {
        rays[ray] = angles_along(field.grid, filter,
                                 random_ray(field.grid, experiment.rays.length, experiment.seed, ray), step);
      });
      Record& record = records.emplace_back(
          Record{.gradient = &filter, .step = step, .pairs = 0, .excluded = 0, .angles = std::nullopt});
      for (const RayAngles& ray : rays) {
        record.pairs += static_cast<std::int64_t>(ray.angles.size()) + ray.excluded;
        record.excluded += ray.excluded;
      }
      if (record.pairs > record.excluded) record.angles = pair_angles(rays);
    }
  return records;
}

}  // namespace

extern const Measure gradient_angles_measure;
const Measure gradient_angles_measure{MeasureDefinition<Options, Record>{
    .name = "gradient_angles",
    .summary = "angles between the normals of consecutive samples, by ways to take gradients",
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
