#include "experiments/measure.hpp"
#include "raytruth/shading/gooch.hpp"
#include "raytruth/shading/normal_curve.hpp"

#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace raytruth {

namespace {

constexpr double largest_angle = 179;
constexpr int points = 4096;

struct Options {
  std::vector<double> angles;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "angles"});
  Options options;
  for (const JsonReader& angle : json.at("angles").items()) options.angles.push_back(angle.number(0, largest_angle));
  return options;
}

/// How dark Gooch's tones become with the normals of a curve, with light from anywhere.
struct Record {
  double angle = 0;
  const NormalCurve* curve = nullptr;
  double largest_norm = 0;

  /// The least weight of the cool tone, (1 + N.L) / 2, and by symmetry of the warm one.
  [[nodiscard]] double least_weight() const { return (1 - largest_norm) / 2; }

  /// The least channel of a colour, of black matter: the tones alone, at the least weight of either.
  [[nodiscard]] double least_color() const {
    const Gooch gooch;
    const Vector3<double> cool = least_weight() * gooch.cool + (1 - least_weight()) * gooch.warm;
    const Vector3<double> warm = least_weight() * gooch.warm + (1 - least_weight()) * gooch.cool;
    return std::min(cool.minCoeff(), warm.minCoeff());
  }
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "angle_degrees",
       .unit = "degree",
       .description = "full angle between the normals",
       .is_key = true,
       .cell = &Record::angle},
      {.name = "curve",
       .description = "between the normals",
       .is_key = true,
       .cell = [](const Record& record) { return record.curve->name; }},
      {.name = "norm_max", .description = "largest |N| along the slab, at 4097 points", .cell = &Record::largest_norm},
      {.name = "weight_min",
       .description = "least weight of a tone, (1 - |N|) / 2, with the light along N or against it",
       .cell = &Record::least_weight},
      {.name = "color_min",
       .unit = "of white",
       .description =
           "least channel of the colour of black matter, tones (0, 0, 0.4) and (0.4, 0.4, 0): negative where "
           "a weight is",
       .cell = &Record::least_color},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const double angle : options.angles)
    for (const NormalCurve& curve : catalogue::normal_curves()) {
      const double cosine = std::cos(angle * boost::math::constants::pi<double>() / 180);
      Record record{.angle = angle, .curve = &curve};
      for (int i = 0; i <= points; ++i)
        record.largest_norm =
            std::max(record.largest_norm, normal_at(curve, static_cast<double>(i) / points, cosine).norm());
      records.push_back(record);
    }
  return records;
}

}  // namespace

extern const Measure gooch_tones_measure;
const Measure gooch_tones_measure{
    MeasureDefinition<Options, Record>{.name = "gooch_tones",
                                       .summary = "the least weights of Gooch's tones by the curve between normals",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_experiment = records}};

}  // namespace raytruth
