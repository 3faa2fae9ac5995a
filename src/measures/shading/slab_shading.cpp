#include "raytruth/shading/slab_shading.hpp"
#include "experiments/measure.hpp"
#include "measures/shading/shading_study.hpp"
#include "raytruth/core/named.hpp"

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

constexpr double largest_angle = 170;
constexpr int points = 4096;  // intervals of the slab between which errors are taken

struct Options {
  std::vector<double> angles;
  std::vector<double> shininesses;
  std::vector<const Highlight*> highlights;
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "angles", "shininess", "highlights"});
  Options options;
  for (const JsonReader& angle : json.at("angles").items()) options.angles.push_back(angle.number(0, largest_angle));
  for (const JsonReader& n : json.at("shininess").items())
    options.shininesses.push_back(n.number(1, largest_shininess));
  std::vector<std::string_view> names;
  for (const Highlight& highlight : catalogue::highlights()) names.push_back(highlight.name);
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

/// One row per method.
void add_rows(Term term, double angle, const Place& place, const Lighting& lighting, std::vector<Row>& rows) {
  const bool is_diffuse = term == Term::diffuse;
  const SlabCosines cosines = cosines_of(studied_slab(angle), lighting);
  const auto truth = profile_of(*find_named(catalogue::shadings(), "normalized_linear"), cosines, lighting, term);
  for (const Shading* const shading : studied_shadings()) {
    // The fades treat both terms; of diffuse light alone they ask no highlight.
    Lighting asked = lighting;
    if (is_diffuse) asked.highlight = find_named(catalogue::highlights(), "cone");
    if (!shading->refusal(asked).empty()) continue;
    const auto values = profile_of(*shading, cosines, asked, term);
    double largest = 0;
    double sum = 0;
    double bias = 0;
    double highest = 0;
    for (std::size_t i = 0; i <= points; ++i) {
      const double error = values[i] - truth[i];
      const double weight = (i == 0 || i == points ? 0.5 : 1.0) / points;
      largest = std::max(largest, std::abs(error));
      highest = std::max(highest, std::abs(truth[i]));
      sum += weight * std::abs(error);
      bias += weight * error;
    }
    rows.push_back({{"term", is_diffuse ? "diffuse" : "specular"},
                    {"highlight", is_diffuse ? Value() : Value(std::string(lighting.highlight->name))},
                    {"shininess", is_diffuse ? Value() : Value(lighting.shininess)},
                    {"angle_degrees", angle},
                    {"light", place.name},
                    {"shading", shading->name},
                    {"error_max", largest},
                    {"error_mean", sum},
                    {"error_signed_mean", bias},
                    {"truth_max", highest}});
  }
}

}  // namespace

std::vector<Column> slab_shading_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "term", .unit = "", .description = "diffuse or specular light, its coefficient 1", .is_key = true},
      {.name = "highlight", .unit = "", .description = "of the method and of the reference", .is_key = true},
      {.name = "shininess", .unit = "", .description = "of the highlight", .is_key = true},
      {.name = "angle_degrees", .unit = "degree", .description = "full angle between the normals", .is_key = true},
      {.name = "light",
       .unit = "",
       .description =
           "where the light (specular: the half vector) is: on the bisector of the normals, on the front "
           "normal, 30 degrees beyond the back normal in their plane, 30 degrees out of it from the bisector",
       .is_key = true},
      {.name = "shading", .unit = "", .description = "the method; negative cosines are clamped", .is_key = true},
      {.name = "error_max", .unit = "", .description = "largest magnitude of the error over 4097 points of the slab"},
      {.name = "error_mean", .unit = "", .description = "mean magnitude of the error, by the trapezoid rule"},
      {.name = "error_signed_mean", .unit = "", .description = "mean of the error, method - normalized_linear"},
      {.name = "truth_max", .unit = "", .description = "largest light of the reference over the slab"},
  };
}

std::vector<Row> slab_shading_rows(const Experiment& /*experiment*/, const JsonReader& options,
                                   const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  for (const double angle : asked.angles)
    for (const Place& place : places(angle)) {
      Lighting lighting;
      lighting.light = place.direction;
      lighting.half = place.direction;
      add_rows(Term::diffuse, angle, place, lighting, rows);
      for (const Highlight* const highlight : asked.highlights)
        for (const double shininess : asked.shininesses) {
          lighting.highlight = highlight;
          lighting.shininess = shininess;
          add_rows(Term::specular, angle, place, lighting, rows);
        }
    }
  return rows;
}

}  // namespace raytruth
