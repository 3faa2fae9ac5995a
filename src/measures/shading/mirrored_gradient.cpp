#include "experiments/measure.hpp"
#include "measures/shading/shading_study.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/shading/normal_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace raytruth {

namespace {

constexpr double smallest_angle = 5;  // of the normals; their mirror images are 180 degrees minus it apart
constexpr double largest_angle = 175;
constexpr int points = 256;  // midpoints of equal parts of the slab

struct Options {
  std::vector<double> angles;
  std::int64_t lights = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "angles", "lights"});
  Options options{.angles = {}, .lights = json.at("lights").integer(100, 1'000'000)};
  for (const JsonReader& angle : json.at("angles").items())
    options.angles.push_back(angle.number(smallest_angle, largest_angle));
  return options;
}

/// A direction of so many that are spread evenly over the sphere, on a spiral.
Vector3<double> direction(std::int64_t i, std::int64_t count) {
  const double height = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
  const double radius = std::sqrt(1 - height * height);
  const double turn = 2 * std::numbers::pi * static_cast<double>(i) / (std::numbers::phi * std::numbers::phi);
  return {radius * std::cos(turn), radius * std::sin(turn), height};
}

/// What mirroring the gradient that is turned away from the light does to a slab's diffuse light.
struct Record {
  double angle = 0;
  const NormalCurve* curve = nullptr;
  std::int64_t lights = 0;  ///< towards which one normal points, and the other does not
  std::int64_t adding = 0;  ///< of these, those whose slab becomes brighter
  double mean = 0;          ///< of the difference
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  double truth = 0;  ///< mean
};

/// The mean of N.L over the slab by the curve between two lit normals.
double mean_light(const NormalCurve& curve, double front, double back, double cosine) {
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double s = (i + 0.5) / points;
    sum += std::abs(front * curve.weight(1 - s, cosine) + back * curve.weight(s, cosine));
  }
  return sum / points;
}

Record record_of(const NormalCurve& curve, double angle, std::int64_t lights) {
  static const NormalCurve& accurate = *find_named(catalogue::normal_curves(), "normalized_linear");
  Record record{.angle = angle, .curve = &curve};
  const ShadedSlab slab = studied_slab(angle);
  const double cosine = slab.cosine();
  for (std::int64_t i = 0; i < lights; ++i) {
    const Vector3<double> light = direction(i, lights);
    const double front = (slab.front_normal * light).sum();
    const double back = (slab.back_normal * light).sum();
    if (!(front * back < 0)) continue;
    // Mirrored, both cosines are positive, and the angle between the normals is 180 degrees minus what it was.
    const double mirrored = mean_light(curve, std::abs(front), std::abs(back), -cosine);
    const double truth = mean_light(accurate, front, back, cosine);
    const double difference = mirrored - truth;
    ++record.lights;
    record.adding += difference > 0 ? 1 : 0;
    record.mean += difference;
    record.truth += truth;
    record.least = std::min(record.least, difference);
    record.most = std::max(record.most, difference);
  }
  record.mean /= static_cast<double>(record.lights);
  record.truth /= static_cast<double>(record.lights);
  return record;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "angle_degrees",
       .unit = "degree",
       .description = "full angle between the normals",
       .is_key = true,
       .cell = &Record::angle},
      {.name = "curve",
       .description = "between the normals, after one is mirrored",
       .is_key = true,
       .cell = [](const Record& record) { return record.curve->name; }},
      {.name = "lights",
       .description = "directions of the light, evenly spread, towards which one normal points and the other does not",
       .cell = &Record::lights},
      {.name = "adding_share",
       .description = "of these, those for which the slab is brighter than with |N.L| of the normalised linear "
                      "interpolation, which joins two arcs where it is perpendicular to the light",
       .cell =
           [](const Record& record) {
             return static_cast<double>(record.adding) / static_cast<double>(record.lights);
           }},
      {.name = "added_mean",
       .description = "mean of what is added to the slab's mean diffuse light, which is at most 1; no attenuation",
       .cell = &Record::mean},
      {.name = "added_min", .description = "least of it", .cell = &Record::least},
      {.name = "added_max", .description = "most of it", .cell = &Record::most},
      {.name = "truth_mean", .description = "mean of the light with |N.L|", .cell = &Record::truth},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const double angle : options.angles)
    for (const NormalCurve& curve : catalogue::normal_curves())
      records.push_back(record_of(curve, angle, options.lights));
  return records;
}

}  // namespace

extern const Measure mirrored_gradient_measure;
const Measure mirrored_gradient_measure{MeasureDefinition<Options, Record>{
    .name = "mirrored_gradient",
    .summary = "what mirroring a gradient that is turned away from the light adds to a slab's light",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
