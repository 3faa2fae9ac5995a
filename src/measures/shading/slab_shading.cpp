#include "raytruth/shading/slab_shading.hpp"
#include "experiments/measure.hpp"
#include "measures/shading/shading_study.hpp"
#include "raytruth/core/named.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

constexpr double largest_angle = 170;
constexpr int points = 4096;  // intervals of the slab between which errors are taken

struct Options {
  std::vector<double> angles;
  std::vector<double> shininesses;
  std::vector<const Highlight*> highlights;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "angles", "shininess", "highlights"});
  Options options;
  for (const JsonReader& angle : json.at("angles").items()) options.angles.push_back(angle.number(0, largest_angle));
  for (const JsonReader& n : json.at("shininess").items())
    options.shininesses.push_back(n.number(1, largest_shininess));
  const std::vector<std::string_view> names = names_of(catalogue::highlights());
  for (const JsonReader& name : json.at("highlights").items())
    options.highlights.push_back(find_named(catalogue::highlights(), name.word(names)));
  return options;
}

struct Place {
  std::string name;
  Vector3<double> direction;
};

/// Where the light is, or the half vector.
std::vector<Place> places(double angle) {
  return {{"bisector", studied_direction(0)},
          {"front_normal", studied_direction(-angle / 2)},
          {"30_beyond_back", studied_direction(angle / 2 + 30)},
          {"30_out_of_plane", studied_direction(0, 30)}};
}

enum class Term { diffuse, specular };

/// The term at the points of the slab.
std::vector<double> profile_of(const Shading& shading, const SlabCosines& cosines, const Lighting& lighting,
                               Term term) {
  const SlabShader shader = shading.shader(cosines, lighting);
  std::vector<double> values(points + 1);
  std::vector<double> others(points + 1);
  double sum = 0;
  double other_sum = 0;
  for (std::size_t i = 0; i <= points; ++i) {
    const LitPoint point = shader.at(static_cast<double>(i) / points, 0);
    values[i] = term == Term::diffuse ? point.diffuse : point.specular;
    others[i] = point.other_specular;
    sum += values[i];
    other_sum += others[i];
  }
  return term == Term::specular && other_sum > sum ? others : values;
}

/// The errors of a method along one slab.
struct Record {
  Term term = Term::diffuse;
  std::optional<std::string_view> highlight;  ///< none: of diffuse light
  std::optional<double> shininess;            ///< likewise
  double angle = 0;
  std::string light;
  const Shading* shading = nullptr;
  double largest = 0;  ///< of the errors' magnitudes
  double mean = 0;     ///< likewise
  double bias = 0;
  double highest_truth = 0;
};

/// Those of every method under this light.
void add_records(Term term, double angle, const Place& place, const Lighting& lighting, std::vector<Record>& records) {
  const bool is_diffuse = term == Term::diffuse;
  const SlabCosines cosines = cosines_of(studied_slab(angle), lighting);
  const auto truth = profile_of(*find_named(catalogue::shadings(), "normalized_linear"), cosines, lighting, term);
  for (const Shading* const shading : studied_shadings()) {
    // The fades treat both terms; of diffuse light alone they ask no highlight.
    Lighting asked = lighting;
    if (is_diffuse) asked.highlight = find_named(catalogue::highlights(), "cone");
    if (!shading->refusal(asked).empty()) continue;
    const auto values = profile_of(*shading, cosines, asked, term);
    Record record{.term = term,
                  .highlight = std::nullopt,
                  .shininess = std::nullopt,
                  .angle = angle,
                  .light = place.name,
                  .shading = shading};
    if (!is_diffuse) {
      record.highlight = lighting.highlight->name;
      record.shininess = lighting.shininess;
    }
    for (std::size_t i = 0; i <= points; ++i) {
      const double error = values[i] - truth[i];
      const double weight = (i == 0 || i == points ? 0.5 : 1.0) / points;
      record.largest = std::max(record.largest, std::abs(error));
      record.highest_truth = std::max(record.highest_truth, std::abs(truth[i]));
      record.mean += weight * std::abs(error);
      record.bias += weight * error;
    }
    records.push_back(record);
  }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "term",
       .description = "diffuse or specular light, its coefficient 1",
       .is_key = true,
       .cell = [](const Record& record) { return record.term == Term::diffuse ? "diffuse" : "specular"; }},
      {.name = "highlight",
       .description = "of the method and of the reference",
       .is_key = true,
       .cell = &Record::highlight},
      {.name = "shininess", .description = "of the highlight", .is_key = true, .cell = &Record::shininess},
      {.name = "angle_degrees",
       .unit = "degree",
       .description = "full angle between the normals",
       .is_key = true,
       .cell = &Record::angle},
      {.name = "light",
       .description =
           "where the light (specular: the half vector) is: on the bisector of the normals, on the front "
           "normal, 30 degrees beyond the back normal in their plane, 30 degrees out of it from the bisector",
       .is_key = true,
       .cell = &Record::light},
      {.name = "shading",
       .description = "the method; negative cosines are clamped",
       .is_key = true,
       .cell = [](const Record& record) { return record.shading->name; }},
      {.name = "error_max",
       .description = "largest magnitude of the error over 4097 points of the slab",
       .cell = &Record::largest},
      {.name = "error_mean",
       .description = "mean magnitude of the error, by the trapezoid rule",
       .cell = &Record::mean},
      {.name = "error_signed_mean",
       .description = "mean of the error, method - normalized_linear",
       .cell = &Record::bias},
      {.name = "truth_max",
       .description = "largest light of the reference over the slab",
       .cell = &Record::highest_truth},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const double angle : options.angles)
    for (const Place& place : places(angle)) {
      Lighting lighting;
      lighting.light = place.direction;
      lighting.half = place.direction;
      add_records(Term::diffuse, angle, place, lighting, records);
      for (const Highlight* const highlight : options.highlights)
        for (const double shininess : options.shininesses) {
          lighting.highlight = highlight;
          lighting.shininess = shininess;
          add_records(Term::specular, angle, place, lighting, records);
        }
    }
  return records;
}

}  // namespace

extern const Measure slab_shading_measure;
const Measure slab_shading_measure{MeasureDefinition<Options, Record>{
    .name = "slab_shading",
    .summary = "errors of the light along a slab, by methods, angles and places of the light",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
