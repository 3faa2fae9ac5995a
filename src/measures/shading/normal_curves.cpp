#include "experiments/measure.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/shading/highlight.hpp"
#include "raytruth/shading/normal_curve.hpp"

#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {

namespace {

struct Options {
  double angle = 0;
  std::vector<double> lights;
  double shininess = 0;
  std::int64_t points = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "angle", "lights", "shininess", "points"});
  Options options{.angle = json.at("angle").number(0, 179),
                  .lights = {},
                  .shininess = json.at("shininess").number(1, 1e6),
                  .points = json.at("points").integer(2, 4096)};
  for (const JsonReader& light : json.at("lights").items()) options.lights.push_back(light.number(-180, 180));
  return options;
}

double radians(double degrees) { return degrees * boost::math::constants::pi<double>() / 180; }

/// The light at a point of a slab.
struct Lit {
  double diffuse = 0;
  double specular = 0;
};

/// A point of a curve between two normals.
struct Record {
  double angle = 0;
  double light = 0;  ///< degrees from the bisector
  const NormalCurve* curve = nullptr;
  double s = 0;
  PlaneVector<double> normal{};
  Lit lit;
  Lit truth;  ///< by the normalised linear interpolation
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "angle", .unit = "degree", .description = "between the normals", .is_key = true, .cell = &Record::angle},
      {.name = "light",
       .unit = "degree",
       .description = "from the bisector of the normals to the light, in their plane, positive towards the back; the "
                      "half vector is there too",
       .is_key = true,
       .cell = &Record::light},
      {.name = "curve",
       .description = "between the normals",
       .is_key = true,
       .cell = [](const Record& record) { return record.curve->name; }},
      {.name = "s",
       .description = "place in the slab, 0 at the front, 1 at the back",
       .is_key = true,
       .cell = &Record::s},
      {.name = "norm", .description = "|N|", .cell = [](const Record& record) { return record.normal.norm(); }},
      {.name = "direction",
       .unit = "degree",
       .description = "from the bisector to N, positive towards the back",
       .cell =
           [](const Record& record) { return record.normal.direction() * 180 / boost::math::constants::pi<double>(); }},
      {.name = "along_bisector",
       .description = "component of N",
       .cell = [](const Record& record) { return record.normal.bisector; }},
      {.name = "along_chord",
       .description = "component of N, positive towards the back",
       .cell = [](const Record& record) { return record.normal.chord; }},
      {.name = "diffuse",
       .description = "max(0, N.L)",
       .cell = [](const Record& record) { return record.lit.diffuse; }},
      {.name = "diffuse_error",
       .description = "diffuse minus that of the normalised linear interpolation",
       .cell = [](const Record& record) { return record.lit.diffuse - record.truth.diffuse; }},
      {.name = "specular",
       .description = "max(0, N.H)^shininess",
       .cell = [](const Record& record) { return record.lit.specular; }},
      {.name = "specular_error",
       .description = "specular minus that of the normalised linear interpolation",
       .cell = [](const Record& record) { return record.lit.specular - record.truth.specular; }},
      {.name = "lit",
       .description = "(diffuse + specular) / 2",
       .cell = [](const Record& record) { return (record.lit.diffuse + record.lit.specular) / 2; }},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  const double cosine = std::cos(radians(options.angle));
  const NormalCurve& reference = *find_named(catalogue::normal_curves(), "normalized_linear");
  const Highlight& lobe = *find_named(catalogue::highlights(), "lobe");
  std::vector<Record> records;
  for (const double light : options.lights) {
    const auto lit = [&](const PlaneVector<double>& normal) -> Lit {
      const double diffuse =
          std::max(0.0, normal.bisector * std::cos(radians(light)) + normal.chord * std::sin(radians(light)));
      return {diffuse, lobe.value(diffuse, options.shininess)};
    };
    for (const NormalCurve& curve : catalogue::normal_curves())
      for (std::int64_t i = 0; i < options.points; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(options.points - 1);
        const PlaneVector<double> normal = normal_at(curve, s, cosine);
        records.push_back({.angle = options.angle,
                           .light = light,
                           .curve = &curve,
                           .s = s,
                           .normal = normal,
                           .lit = lit(normal),
                           .truth = lit(normal_at(reference, s, cosine))});
      }
  }
  return records;
}

}  // namespace

extern const Measure normal_curves_measure;
const Measure normal_curves_measure{MeasureDefinition<Options, Record>{
    .name = "normal_curves",
    .summary = "curves between two normals, point by point, and what light makes of them",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
