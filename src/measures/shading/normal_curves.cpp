#include "experiments/measure.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/shading/highlight.hpp"
#include "raytruth/shading/normal_curve.hpp"

#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

struct Options {
  double angle = 0;
  std::vector<double> lights;
  double shininess = 0;
  std::int64_t points = 0;
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "angle", "lights", "shininess", "points"});
  Options options{.angle = json.at("angle").number(0, 179),
                  .lights = {},
                  .shininess = json.at("shininess").number(1, 1e6),
                  .points = json.at("points").integer(2, 4096)};
  for (const JsonReader& light : json.at("lights").items()) options.lights.push_back(light.number(-180, 180));
  return options;
}

double radians(double degrees) { return degrees * boost::math::constants::pi<double>() / 180; }

}  // namespace

std::vector<Column> normal_curves_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "angle", .unit = "degree", .description = "between the normals", .is_key = true},
      {.name = "light",
       .unit = "degree",
       .description = "from the bisector of the normals to the light, in their plane, positive towards the back; the "
                      "half vector is there too",
       .is_key = true},
      {.name = "curve", .unit = "", .description = "between the normals", .is_key = true},
      {.name = "s", .unit = "", .description = "place in the slab, 0 at the front, 1 at the back", .is_key = true},
      {.name = "norm", .unit = "", .description = "|N|"},
      {.name = "direction", .unit = "degree", .description = "from the bisector to N, positive towards the back"},
      {.name = "along_bisector", .unit = "", .description = "component of N"},
      {.name = "along_chord", .unit = "", .description = "component of N, positive towards the back"},
      {.name = "diffuse", .unit = "", .description = "max(0, N.L)"},
      {.name = "diffuse_error", .unit = "", .description = "diffuse minus that of the normalised linear interpolation"},
      {.name = "specular", .unit = "", .description = "max(0, N.H)^shininess"},
      {.name = "specular_error",
       .unit = "",
       .description = "specular minus that of the normalised linear interpolation"},
      {.name = "lit", .unit = "", .description = "(diffuse + specular) / 2"},
  };
}

std::vector<Row> normal_curves_rows(const Experiment& /*experiment*/, const JsonReader& json, const Field& /*field*/) {
  const Options options = read_options(json);
  const double cosine = std::cos(radians(options.angle));
  const NormalCurve& reference = *find_named(catalogue::normal_curves(), "normalized_linear");
  const Highlight& lobe = *find_named(catalogue::highlights(), "lobe");
  std::vector<Row> rows;
  for (const double light : options.lights) {
    const auto along_light = [light](const PlaneVector<double>& normal) {
      return std::max(0.0, normal.bisector * std::cos(radians(light)) + normal.chord * std::sin(radians(light)));
    };
    for (const NormalCurve& curve : catalogue::normal_curves())
      for (std::int64_t i = 0; i < options.points; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(options.points - 1);
        const PlaneVector<double> normal = normal_at(curve, s, cosine);
        const double diffuse = along_light(normal);
        const double true_diffuse = along_light(normal_at(reference, s, cosine));
        const double specular = lobe.value(diffuse, options.shininess);
        rows.push_back({{"angle", options.angle},
                        {"light", light},
                        {"curve", std::string(curve.name)},
                        {"s", s},
                        {"norm", normal.norm()},
                        {"direction", normal.direction() * 180 / boost::math::constants::pi<double>()},
                        {"along_bisector", normal.bisector},
                        {"along_chord", normal.chord},
                        {"diffuse", diffuse},
                        {"diffuse_error", diffuse - true_diffuse},
                        {"specular", specular},
                        {"specular_error", specular - lobe.value(true_diffuse, options.shininess)},
                        {"lit", (diffuse + specular) / 2}});
      }
  }
  return rows;
}

}  // namespace raytruth
