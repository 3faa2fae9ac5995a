#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
#include "raytruth/reference/surface_hits.hpp"
#include "raytruth/reference/surroundings_of.hpp"
#include "raytruth/signals/point_gradient.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/statistics/statistics.hpp"
#include "raytruth/transfer/isoslab.hpp"

#include <tbb/parallel_for.h>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr double narrowest = 0x1p-20;
constexpr double most_opaque = 1 - 0x1p-20;

/// What differs from the surface by more is told from rounding.
constexpr double different = 1e-9;

struct Options {
  double share = 0;    ///< of the data's range, where the isosurface lies
  double opacity = 0;  ///< of one crossing
  std::vector<double> widths;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "share", "opacity", "widths"});
  Options options{.share = json.at("share").number(0, 1),
                  .opacity = json.at("opacity").number(narrowest, most_opaque),
                  .widths = {}};
  for (const JsonReader& width : json.at("widths").items()) {
    options.widths.push_back(width.number(narrowest, 1));
    if (options.widths.size() > 1 && !(options.widths.back() < options.widths[options.widths.size() - 2]))
      width.refuse_value("a width below the one before");
  }
  return options;
}

constexpr std::array densities{std::pair{IsoslabDensity::per_crossing, std::string_view("per_crossing")},
                               std::pair{IsoslabDensity::per_length, std::string_view("per_length")}};

/// What is seen of a ray: its opacity, and the light of a white surface lit from the viewer, K_d = 1.
struct Seen {
  double opacity = 0;
  double light = 0;
};

/// A ray and what lights it.
struct LitRay {
  Ray ray;
  std::array<double, 3> direction;  ///< a unit vector
  Chain<3> signal;
  std::vector<SurfaceHit> hits;

  /// abs(N.L) of the viewer's own light; 0 without a normal.
  [[nodiscard]] double light_at(const PointGradient& gradient, double t) const {
    std::array<double, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = ray.origin[axis] + t * direction[axis];
    const Vector3<double> normal = gradient(place);
    const double norm = normal.matrix().norm();
    if (norm == 0) return 0;
    return std::abs(normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2]) / norm;
  }

  /// abs(ds/dt), of the piece behind where two of them meet.
  [[nodiscard]] double slope_at(double t) const {
    const auto& piece = signal.pieces[signal.index_at(DoubleDouble(t))];
    return std::abs(piece.polynomial.derivative().value(piece.local(DoubleDouble(t)))) / piece.length;
  }
};

/// The surface itself, where every crossing has an opacity of its own.
template <class OpacityOf>
Seen surface_of(const LitRay& ray, const PointGradient& gradient, OpacityOf&& opacity_of) {
  Seen seen;
  for (const SurfaceHit& hit : ray.hits) {
    const auto t = static_cast<double>(hit.t);
    const double opacity = opacity_of(t);
    seen.light += (1 - seen.opacity) * opacity * ray.light_at(gradient, t);
    seen.opacity += (1 - seen.opacity) * opacity;
  }
  return seen;
}

/// A slab between two scalars, whose extinction is `factor` abs(ds/dt), or `factor` per length.
struct Slab {
  IsoslabDensity density;
  double low;
  double high;
  double factor;

  /// Its depth over part of a piece on which the scalar is monotone, all inside or all outside.
  [[nodiscard]] double depth(const Piece<3>& piece, double begin, double end) const {
    if (density == IsoslabDensity::per_length) return factor * piece.length * (end - begin);
    const auto clamped = [&](double u) { return std::clamp(piece.polynomial.value(u), low, high); };
    return factor * std::abs(clamped(end) - clamped(begin));
  }

  [[nodiscard]] double extinction(const Piece<3>& piece, const Bernstein<2>& derivative, double u) const {
    return density == IsoslabDensity::per_length ? factor * piece.length : factor * std::abs(derivative.value(u));
  }
};

/// The slab's depth adds up exactly but for rounding; its light is Gauss's, on parts where the signal is a monotone
/// cubic and the gradient a polynomial.
Seen slab_of(const LitRay& ray, const PointGradient& gradient, const Slab& slab) {
  double depth = 0;
  Seen seen;
  for (const Piece<3>& piece : ray.signal.pieces) {
    const auto [lowest, highest] = piece.polynomial.range();
    if (highest <= slab.low || lowest >= slab.high) continue;
    const Bernstein<2> derivative = piece.polynomial.derivative();
    std::vector<double> ends{0, 1};
    const auto add = [&ends](const auto& places) { ends.insert(ends.end(), places.begin(), places.end()); };
    add(derivative.sign_changes());
    for (const double border : {slab.low, slab.high}) {
      Bernstein<3> above = piece.polynomial;
      for (double& coefficient : above.coefficients) coefficient -= border;
      add(above.sign_changes());
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double begin = ends[i - 1];
      const double end = ends[i];
      const double middle = piece.polynomial.value(begin + (end - begin) / 2);
      if (!(begin < end) || middle <= slab.low || middle >= slab.high) continue;
      const auto start = static_cast<double>(piece.start);
      seen.light += boost::math::quadrature::gauss<double, 10>::integrate(
          [&](double u) {
            return std::exp(-depth - slab.depth(piece, begin, u)) * slab.extinction(piece, derivative, u) *
                   ray.light_at(gradient, start + u * piece.length);
          },
          begin, end);
      depth += slab.depth(piece, begin, end);
    }
  }
  seen.opacity = -std::expm1(-depth);
  return seen;
}

/// The errors of an ensemble of rays, mean and root mean square.
struct Errors {
  double mean = 0;
  double rms = 0;
};

struct Record {
  std::string density;
  double width = 0;
  std::int64_t rays = 0;
  std::int64_t rays_unresolved = 0;
  std::int64_t crossings = 0;
  double slope = 0;
  double differing = 0;  ///< share of rays
  Errors opacity;        ///< against the surface
  Errors light;
  Errors limit;           ///< opacity, against the density's own limit
  ShownQuantiles limits;  ///< opacities of crossings, per_length at the width 0
  std::array<std::optional<double>, 5> orders = {};
};

/// What falls with the width, and how a row tells it.
const std::array<std::pair<std::string, double (*)(const Record&)>, 5>& falling() {
  static const std::array<std::pair<std::string, double (*)(const Record&)>, 5> list{
      {{"differing", [](const Record& record) { return record.differing; }},
       {"opacity_error_mean", [](const Record& record) { return record.opacity.mean; }},
       {"opacity_error_rms", [](const Record& record) { return record.opacity.rms; }},
       {"light_error_mean", [](const Record& record) { return record.light.mean; }},
       {"limit_error_mean", [](const Record& record) { return record.limit.mean; }}}};
  return list;
}

/// The powers of the width with which these fall from a slab to a narrower one.
void add_orders(const Record& wider, Record& here) {
  for (std::size_t i = 0; i < falling().size(); ++i) {
    const auto value_of_row = falling()[i].second;
    if (value_of_row(wider) > 0 && value_of_row(here) > 0)
      here.orders[i] = std::log(value_of_row(wider) / value_of_row(here)) / std::log(wider.width / here.width);
  }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> list{
      {.name = "density",
       .description = "of the slab: per_crossing, extinction (D / width) abs(ds/dt), or per_length, (D / width) slope",
       .is_key = true,
       .cell = &Record::density},
      {.name = "width",
       .description = "of the slab, a share of the data's range; 0: the limit itself",
       .is_key = true,
       .cell = &Record::width},
      {.name = "rays", .description = "rays whose crossings are all certified", .cell = &Record::rays},
      {.name = "rays_unresolved",
       .description = "rays with a contact that is not resolved; they are left out",
       .cell = &Record::rays_unresolved},
      {.name = "crossings", .description = "certified crossings of these rays", .cell = &Record::crossings},
      {.name = "slope",
       .unit = "range/voxel",
       .description = "the median of abs(ds/dt) over the crossings, at which a passage per_length has the depth D",
       .cell = &Record::slope},
      {.name = "differing",
       .description = "share of rays whose opacity differs from the surface's by more than 1e-9",
       .cell = &Record::differing},
      {.name = "opacity_error_mean",
       .description = "mean distance of a ray's opacity from the surface's",
       .cell = [](const Record& record) { return record.opacity.mean; }},
      {.name = "opacity_error_rms",
       .description = "root mean square of it",
       .cell = [](const Record& record) { return record.opacity.rms; }},
      {.name = "light_error_mean",
       .description = "mean distance of a ray's light from the surface's: white, lit by abs(N.L) from the viewer",
       .cell = [](const Record& record) { return record.light.mean; }},
      {.name = "light_error_rms",
       .description = "root mean square of it",
       .cell = [](const Record& record) { return record.light.rms; }},
      {.name = "limit_error_mean",
       .description = "mean distance of a ray's opacity from the limit of its own density, per_length "
                      "1 - (1 - opacity)^(slope/abs(ds/dt)) for each crossing",
       .cell = [](const Record& record) { return record.limit.mean; }},
      {.name = "limit_error_rms", .description = "root mean square of it", .cell = [](const Record& record) {
         return record.limit.rms;
       }}};
  for (std::size_t i = 0; i < falling().size(); ++i)
    list.push_back({.name = falling()[i].first + "_order",
                    .description = "log of the ratio of " + falling()[i].first +
                                   " at the width before to that here, over the log of the ratio of widths",
                    .cell = [i](const Record& record) { return record.orders[i]; }});
  append_part(list, &Record::limits,
              shown_quantile_columns("crossing_opacity", "", "opacity of a crossing in the limit of per_length"));
  return list;
}

/// What is made of one ray.
struct Outcomes {
  Seen surface;
  std::array<Seen, densities.size()> limit;
  std::array<std::vector<Seen>, densities.size()> slabs;  ///< by width
};

Errors errors_of(const std::vector<double>& differences) {
  Errors errors;
  for (const double difference : differences) {
    errors.mean += std::abs(difference);
    errors.rms += difference * difference;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(differences.size(), 1));
  errors.mean /= count;
  errors.rms = std::sqrt(errors.rms / count);
  return errors;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  const TrilinearField traced(field.grid);
  // Random rays are along no axis.
  const Surroundings surroundings{.steepest = steepest_slope(traced)};
  const PointGradient gradient(field.grid);
  const auto count = static_cast<std::size_t>(experiment.rays.count);
  const std::vector<double> scalars{options.share};

  std::vector<std::optional<LitRay>> rays(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    LitRay ray{.ray = random_ray(field.grid, experiment.rays.length, experiment.seed, i),
               .direction = {},
               .signal = {},
               .hits = {}};
    ray.direction = unit_direction(ray.ray.direction);
    SurfaceHits truth = surface_hits(traced.trace_precisely(ray.ray), scalars, surroundings);
    if (!truth.unresolved.empty()) return;
    ray.hits = std::move(truth.hits);
    traced.trace(ray.ray, ray.signal);
    rays[i] = std::move(ray);
  });

  std::vector<double> slopes;
  std::int64_t resolved = 0;
  for (const auto& ray : rays) {
    if (!ray) continue;
    ++resolved;
    for (const SurfaceHit& hit : ray->hits) slopes.push_back(ray->slope_at(static_cast<double>(hit.t)));
  }
  std::sort(slopes.begin(), slopes.end());
  const double slope = slopes.empty() ? 0 : quantile(slopes, 0.5);
  const double depth = -std::log1p(-options.opacity);
  const auto limit_opacity = [&](double slope_here) { return -std::expm1(-depth * slope / slope_here); };

  std::vector<Outcomes> outcomes(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    if (!rays[i]) return;
    const LitRay& ray = *rays[i];
    Outcomes& outcome = outcomes[i];
    outcome.surface = surface_of(ray, gradient, [&](double /*t*/) { return options.opacity; });
    outcome.limit = {outcome.surface,
                     surface_of(ray, gradient, [&](double t) { return limit_opacity(ray.slope_at(t)); })};
    for (std::size_t which = 0; which < densities.size(); ++which)
      for (const double width : options.widths) {
        const IsoslabDensity density = densities[which].first;
        outcome.slabs[which].push_back(
            slab_of(ray, gradient,
                    {.density = density,
                     .low = options.share - width / 2,
                     .high = options.share + width / 2,
                     .factor = depth / width * (density == IsoslabDensity::per_length ? slope : 1)}));
      }
  });

  std::vector<double> opacities;
  for (const double here : slopes) opacities.push_back(limit_opacity(here));
  std::sort(opacities.begin(), opacities.end());

  std::vector<Record> records;
  for (std::size_t which = 0; which < densities.size(); ++which) {
    const auto add = [&](double width, auto seen_of) {
      std::vector<double> opacity;
      std::vector<double> light;
      std::vector<double> limit;
      std::int64_t differing = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (!rays[i]) continue;
        const Seen& seen = seen_of(outcomes[i]);
        opacity.push_back(seen.opacity - outcomes[i].surface.opacity);
        light.push_back(seen.light - outcomes[i].surface.light);
        limit.push_back(seen.opacity - outcomes[i].limit[which].opacity);
        differing += std::abs(opacity.back()) > different ? 1 : 0;
      }
      records.push_back(
          {.density = std::string(densities[which].second),
           .width = width,
           .rays = resolved,
           .rays_unresolved = static_cast<std::int64_t>(count) - resolved,
           .crossings = std::ssize(slopes),
           .slope = slope,
           .differing = static_cast<double>(differing) / static_cast<double>(std::max<std::int64_t>(resolved, 1)),
           .opacity = errors_of(opacity),
           .light = errors_of(light),
           .limit = errors_of(limit),
           .limits = {}});
      if (width > 0 && width < options.widths.front()) add_orders(records[records.size() - 2], records.back());
    };
    for (std::size_t k = 0; k < options.widths.size(); ++k)
      add(options.widths[k], [which, k](const Outcomes& outcome) -> const Seen& { return outcome.slabs[which][k]; });
    if (densities[which].first == IsoslabDensity::per_crossing) continue;
    add(0, [which](const Outcomes& outcome) -> const Seen& { return outcome.limit[which]; });
    records.back().limits = shown_quantiles(opacities);
  }
  return records;
}

}  // namespace

extern const Measure isosurface_limit_measure;
const Measure isosurface_limit_measure{
    MeasureDefinition<Options, Record>{.name = "isosurface_limit",
                                       .summary = "how fast slabs of matter around isosurfaces become these surfaces",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_field = records_of_field}};

}  // namespace raytruth
