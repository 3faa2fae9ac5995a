#include "experiments/measure.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/shading/slab_shading.hpp"

#include <tbb/parallel_for.h>
#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_draws = 1'000'000;

/// How far to either side of a border between cases the lighting is taken.
constexpr double aside = 1e-9;

struct Options {
  std::vector<double> angles;
  double shininess = 0;
  std::int64_t draws = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "angles", "shininess", "draws"});
  Options options;
  for (const JsonReader& angle : json.at("angles").items()) options.angles.push_back(angle.number(1, 170));
  options.shininess = json.at("shininess").number(2, 1e4);
  options.draws = json.at("draws").integer(1, most_draws);
  return options;
}

/// Where something may jump.
enum class Place { slab_border, front_light, back_light, front_half, back_half };

constexpr std::array places{
    std::pair{Place::slab_border, "slab_border"}, std::pair{Place::front_light, "front_light"},
    std::pair{Place::back_light, "back_light"},   std::pair{Place::front_half, "front_half"},
    std::pair{Place::back_half, "back_half"},
};

Vector3<double> unit(const Vector3<double>& vector) { return vector / vector.matrix().norm(); }

/// An isotropic unit vector.
Vector3<double> direction_of(std::uint64_t seed, std::uint64_t index, std::uint32_t which) {
  const auto numbers = random_numbers(seed, RandomStream::points, index, which);
  const double z = 2 * numbers[0] - 1;
  const double phi = 2 * boost::math::constants::pi<double>() * numbers[1];
  return {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
}

/// A unit vector at this angle (cosine) from another one.
Vector3<double> turned(const Vector3<double>& from, double cosine, const Vector3<double>& any) {
  const Vector3<double> across = unit(any - (any * from).sum() * from);
  return cosine * from + std::sqrt(1 - cosine * cosine) * across;
}

/// Diffuse and specular light, in this order.
using Light = std::array<double, 2>;

Light at_point(const Shading& shading, const SlabCosines& cosines, const Lighting& lighting, double x) {
  const LitPoint point = shading.shader(cosines, lighting).at(x, 0);
  return {point.diffuse, std::max(point.specular, point.other_specular)};
}

/// The mean over the slab: its light where matter is thin and even.
Light mean_over_slab(const Shading& shading, const SlabCosines& cosines, const Lighting& lighting) {
  const SlabShader shader = shading.shader(cosines, lighting);
  std::vector<double> ends{0, 1};
  const std::vector<double> breaks = shader.breaks();
  ends.insert(ends.end(), breaks.begin(), breaks.end());
  std::sort(ends.begin(), ends.end());
  LitPoint mean;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const auto integral = [&](double LitPoint::*term) {
      return boost::math::quadrature::gauss<double, 30>::integrate([&](double x) { return shader.at(x, 0).*term; },
                                                                   ends[i - 1], ends[i]);
    };
    mean.diffuse += integral(&LitPoint::diffuse);
    mean.specular += integral(&LitPoint::specular);
    mean.other_specular += integral(&LitPoint::other_specular);
  }
  return {mean.diffuse, std::max(mean.specular, mean.other_specular)};
}

/// The jump of the light at a place, for normals, light and half vector drawn by the index.
Light jump_at(Place place, const Shading& shading, Lighting lighting, double angle, std::uint64_t seed,
              std::uint64_t index) {
  lighting.light = direction_of(seed, index, 0);
  lighting.half = direction_of(seed, index, 1);
  const double cosine = std::cos(angle * boost::math::constants::pi<double>() / 180);
  const Vector3<double> any = direction_of(seed, index, 2);
  const auto difference = [](const Light& one, const Light& other) {
    return Light{std::abs(one[0] - other[0]), std::abs(one[1] - other[1])};
  };
  if (place == Place::slab_border) {
    const ShadedSlab before{.front_normal = turned(any, cosine, direction_of(seed, index, 3)), .back_normal = any};
    const ShadedSlab behind{.front_normal = any, .back_normal = turned(any, cosine, direction_of(seed, index, 4))};
    return difference(at_point(shading, cosines_of(before, lighting), lighting, 1),
                      at_point(shading, cosines_of(behind, lighting), lighting, 0));
  }
  const bool is_light = place == Place::front_light || place == Place::back_light;
  const bool is_front = place == Place::front_light || place == Place::front_half;
  const double border = is_light ? 0 : Illumination(lighting).threshold();
  const Vector3<double> on_border = turned(is_light ? lighting.light : lighting.half, border, any);
  const Vector3<double> other = turned(on_border, cosine, direction_of(seed, index, 3));
  const SlabCosines cosines =
      cosines_of({.front_normal = is_front ? on_border : other, .back_normal = is_front ? other : on_border}, lighting);
  const auto moved = [&](double by) {
    SlabCosines result = cosines;
    (is_light   ? is_front ? result.light_front : result.light_back
     : is_front ? result.half_front
                : result.half_back) = border + by;
    return mean_over_slab(shading, result, lighting);
  };
  return difference(moved(-aside), moved(aside));
}

/// The jumps of a method at a place over all draws.
struct Record {
  const Shading* shading = nullptr;
  const char* place = nullptr;
  double angle = 0;
  std::int64_t draws = 0;
  Light largest{};
  Light mean{};
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "shading",
       .description = "the method; the highlight is the cone, clamped",
       .is_key = true,
       .cell = [](const Record& record) { return record.shading->name; }},
      {.name = "place",
       .description =
           "slab_border: light at a sample, as the end of one slab and as the beginning of the next; others: "
           "mean light of a slab, front_light: as N_f.L passes 0, back_light: N_b.L, front_half: as N_f.H "
           "passes the foot of the highlight, back_half: N_b.H",
       .is_key = true,
       .cell = &Record::place},
      {.name = "angle",
       .unit = "degree",
       .description = "between the normals of a slab",
       .is_key = true,
       .cell = &Record::angle},
      {.name = "draws", .description = "random normals, lights and half vectors", .cell = &Record::draws},
      {.name = "diffuse_jump_max",
       .description = "largest jump of the diffuse light, K_d = 1",
       .cell = [](const Record& record) { return record.largest[0]; }},
      {.name = "diffuse_jump_mean",
       .description = "mean of it",
       .cell = [](const Record& record) { return record.mean[0]; }},
      {.name = "specular_jump_max",
       .description = "largest jump of the specular light, K_s = 1",
       .cell = [](const Record& record) { return record.largest[1]; }},
      {.name = "specular_jump_mean",
       .description = "mean of it",
       .cell = [](const Record& record) { return record.mean[1]; }},
  };
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  const Lighting lighting{
      .specular = 1, .shininess = options.shininess, .highlight = find_named(catalogue::highlights(), "cone")};
  std::vector<Record> records;
  for (const Shading& shading : catalogue::shadings()) {
    if (!shading.refusal(lighting).empty()) continue;
    for (const auto& [place, name] : places)
      for (const double angle : options.angles) {
        std::vector<Light> jumps(static_cast<std::size_t>(options.draws));
        tbb::parallel_for(std::size_t{0}, jumps.size(), [&, at = place](std::size_t i) {
          jumps[i] = jump_at(at, shading, lighting, angle, experiment.seed, i);
        });
        Record record{.shading = &shading, .place = name, .angle = angle, .draws = options.draws};
        Light sum{};
        for (const Light& jump : jumps)
          for (std::size_t term = 0; term < 2; ++term) {
            record.largest[term] = std::max(record.largest[term], jump[term]);
            sum[term] += jump[term];
          }
        for (std::size_t term = 0; term < 2; ++term) record.mean[term] = sum[term] / static_cast<double>(options.draws);
        records.push_back(record);
      }
  }
  return records;
}

}  // namespace

extern const Measure continuity_measure;
const Measure continuity_measure{MeasureDefinition<Options, Record>{
    .name = "continuity",
    .summary = "jumps of the light across the borders of slabs and of the cases of their shading",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
