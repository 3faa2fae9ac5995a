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

std::vector<double> read_steps(const Experiment& experiment, const JsonReader& options) {
  options.only({"kind", "steps"});
  std::vector<double> steps;
  for (const JsonReader& step : options.at("steps").items())
    steps.push_back(step.number(smallest_step, experiment.rays.length));
  return steps;
}

/// The consecutive samples of a ray.
struct RayAngles {
  std::vector<double> angles;  ///< degrees, of pairs whose gradients both have a direction
  std::int64_t excluded = 0;
};

double angle_between(const Vector3<double>& first, const Vector3<double>& second) {
  // Of unit vectors; accurate for small angles too (W. Kahan, How futile are mindless assessments of roundoff, 2006).
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
Value largest_error(const NormalError& of, std::string_view curve_name, double angle) {
  const double cosine = std::cos(angle * boost::math::constants::pi<double>() / 180);
  const NormalCurve& curve = *find_named(catalogue::normal_curves(), curve_name);
  const NormalCurve& reference = *find_named(catalogue::normal_curves(), "normalized_linear");
  const double error = largest_over_slab<double>([&](double s) {
                         return of.error(normal_at(curve, s, cosine), normal_at(reference, s, cosine));
                       }).second;
  return std::isfinite(error) ? Value(error) : Value();
}

}  // namespace

std::vector<Column> gradient_angles_columns(const Experiment& experiment, const JsonReader& options) {
  read_steps(experiment, options);
  std::vector<Column> columns{
      {.name = "gradient", .unit = "", .description = "how gradients are taken at voxels", .is_key = true},
      {.name = "step", .unit = "voxel", .description = "distance of samples", .is_key = true},
      {.name = "pairs", .unit = "", .description = "consecutive samples along rays"},
      {.name = "excluded_share",
       .unit = "",
       .description = "share of pairs left out: a gradient of at most 1e-3 range/voxel has no direction"},
  };
  for (const int angle : counted_angles)
    append(
        columns,
        {{.name = fmt::format("above_{}", angle),
          .unit = "",
          .description = fmt::format("share of the other pairs with an angle above {} degrees", angle)},
         {.name = fmt::format("above_{}_low", angle), .unit = "", .description = "95 % interval, clustered by ray"},
         {.name = fmt::format("above_{}_high", angle), .unit = "", .description = "95 % interval, clustered by ray"}});
  append(columns, quantile_columns("angle", "degree", "angle between the normals of two consecutive samples"));
  append(columns, {{.name = "angle_max", .unit = "degree", .description = "largest of these angles"}});
  for (const NormalError& of : normal_errors)
    for (const std::string_view curve : curves)
      for (const int percent : error_percents)
        columns.push_back(
            {.name = fmt::format("{}_{}_p{}", curve, of.name, percent),
             .unit = "",
             .description = fmt::format("by {} at angle_p{}: {}; null: singular", curve, percent, of.description)});
  return columns;
}

std::vector<Row> gradient_angles_rows(const Experiment& experiment, const JsonReader& options, const Field& field) {
  std::vector<Row> rows;
  for (const double step : read_steps(experiment, options))
    for (const GradientFilter& filter : catalogue::gradient_filters()) {
      std::vector<RayAngles> rays(static_cast<std::size_t>(experiment.rays.count));
      tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t ray) {
        rays[ray] = angles_along(field.grid, filter,
                                 random_ray(field.grid, experiment.rays.length, experiment.seed, ray), step);
      });
      std::vector<double> angles;
      std::int64_t excluded = 0;
      for (const RayAngles& ray : rays) {
        angles.insert(angles.end(), ray.angles.begin(), ray.angles.end());
        excluded += ray.excluded;
      }
      const auto pairs = static_cast<std::int64_t>(angles.size()) + excluded;
      Row& row = rows.emplace_back(Row{{"gradient", std::string(filter.name)},
                                       {"step", step},
                                       {"pairs", pairs},
                                       {"excluded_share", static_cast<double>(excluded) / static_cast<double>(pairs)}});
      if (angles.empty()) continue;
      for (const int angle : counted_angles) {
        std::vector<Cluster> clusters;
        for (const RayAngles& ray : rays)
          clusters.push_back({.hits = std::count_if(ray.angles.begin(), ray.angles.end(),
                                                    [angle](double of_pair) { return of_pair > angle; }),
                              .trials = static_cast<std::int64_t>(ray.angles.size())});
        const Proportion share = clustered_proportion(clusters);
        const std::string name = fmt::format("above_{}", angle);
        row.insert(row.end(), {{name, share.estimate}, {name + "_low", share.low}, {name + "_high", share.high}});
      }
      std::sort(angles.begin(), angles.end());
      add_quantiles(row, "angle", angles);
      row.emplace_back("angle_max", angles.back());
      for (const NormalError& of : normal_errors)
        for (const std::string_view curve : curves)
          for (const int percent : error_percents)
            row.emplace_back(fmt::format("{}_{}_p{}", curve, of.name, percent),
                             largest_error(of, curve, quantile(angles, percent / 100.0)));
    }
  return rows;
}

}  // namespace raytruth
