#include "experiments/measure.hpp"

#include <array>

namespace raytruth {

extern const Measure cell_cubic;
extern const Measure conformance;
extern const Measure costs;
extern const Measure error_waterfall;
extern const Measure frequency_responses;
extern const Measure gl_functions;
extern const Measure gl_rays;
extern const Measure gl_renderer;
extern const Measure images;
extern const Measure integral_orders;
extern const Measure iterations;
extern const Measure minmax_bounds;
extern const Measure opacity_conventions;
extern const Measure opacity_recursion;
extern const Measure optimal_table;
extern const Measure orders;
extern const Measure reference_proof;
extern const Measure signal_error;
extern const Measure table_pareto;
extern const Measure table_texture_precision;
extern const Measure turning_points;
extern const Measure virtual_samples;
extern const Measure volume_texture_precision;
extern const Measure work_precision;
extern const Measure xi_versus_integral;

namespace {

struct Legacy {
  std::string_view name;
  std::string_view summary;
  bool of_fields;
  std::vector<Column> (*columns)(const Experiment&, const JsonReader& options);
  std::vector<Row> (*rows)(const Experiment&, const JsonReader& options, const Field&);
  std::int64_t (*blocks)(const JsonReader& options) = nullptr;
  std::vector<Row> (*block_rows)(const Experiment&, const JsonReader& options, std::int64_t block) = nullptr;
  bool uses_gl = false;
  std::vector<Row> (*conclusions)(const Experiment&, const JsonReader& options, const std::vector<Row>& rows) = nullptr;
};

constexpr Legacy with_conclusions(Legacy measure, decltype(Legacy::conclusions) conclusions) {
  measure.conclusions = conclusions;
  return measure;
}

constexpr Legacy with_gl(Legacy measure) {
  measure.uses_gl = true;
  return measure;
}

class LegacyMeasure final : public AskedMeasure {
 public:
  LegacyMeasure(const Measure& measure, const Legacy& legacy, const Experiment& experiment, const JsonReader& options)
      : AskedMeasure(measure), legacy_(legacy), options_(options), columns_(legacy.columns(experiment, options)) {}
  [[nodiscard]] std::vector<Column> columns() const override { return columns_; }
  [[nodiscard]] std::int64_t blocks() const override {
    return legacy_.blocks != nullptr ? legacy_.blocks(options_) : 1;
  }
  [[nodiscard]] std::vector<Row> rows(const Experiment& experiment, const Field& field,
                                      std::int64_t block) const override {
    return legacy_.block_rows != nullptr ? legacy_.block_rows(experiment, options_, block)
                                         : legacy_.rows(experiment, options_, field);
  }
  [[nodiscard]] std::vector<Row> conclusions(const Experiment& experiment,
                                             const std::vector<Row>& rows) const override {
    return legacy_.conclusions != nullptr ? legacy_.conclusions(experiment, options_, rows) : std::vector<Row>{};
  }

 private:
  Legacy legacy_;
  JsonReader options_;
  std::vector<Column> columns_;
};

Measure old(const Legacy& legacy) {
  return {legacy.name, legacy.summary, legacy.of_fields, legacy.uses_gl,
          [legacy](const Measure& measure, const Experiment& experiment, const JsonReader& options) {
            return std::make_shared<const LegacyMeasure>(measure, legacy, experiment, options);
          }};
}

}  // namespace

std::vector<Column> table_builds_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> table_builds_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> weighted_tables_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> weighted_tables_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> distance_axis_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> distance_axis_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> eta_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> eta_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> cone_lobe_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> cone_lobe_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> normal_curves_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> normal_curves_rows(const Experiment& experiment, const JsonReader& json, const Field& field);

std::vector<Column> spheres_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> spheres_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> continuity_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> continuity_rows(const Experiment& experiment, const JsonReader& json, const Field& field);

std::vector<Column> gradient_angles_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> gradient_angles_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> table_resolution_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> table_resolution_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> table_error_map_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> table_error_map_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> table_formats_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> table_formats_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> second_order_table_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> second_order_table_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> partial_pre_integration_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> partial_pre_integration_rows(const Experiment& experiment, const JsonReader& options,
                                              const Field& field);

std::vector<Column> slab_shading_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> slab_shading_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> clamps_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> clamps_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> shading_integrals_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> shading_integrals_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

const Measure table_builds =
    old(Legacy{"table_builds", "composites and exponentials of table builders, and their differences to exact tables",
               false, table_builds_columns, table_builds_rows});
const Measure weighted_tables =
    old(Legacy{"weighted_tables", "digits that weighted tables lose, as the printed difference and as sums", false,
               weighted_tables_columns, weighted_tables_rows});
const Measure distance_axis =
    old(Legacy{"distance_axis", "errors of tables for distances 2^j: the interpolation's and the algorithm's", false,
               distance_axis_columns, distance_axis_rows});
const Measure eta =
    old(Legacy{"eta", "the length and the direction of the normal between two samples, by ways to normalise it", false,
               eta_columns, eta_rows});
const Measure cone_lobe = old(Legacy{"cone_lobe", "highlights that stand for the lobe: deviation, energy, threshold",
                                     false, cone_lobe_columns, cone_lobe_rows});
const Measure normal_curves =
    old(Legacy{"normal_curves", "curves between two normals, point by point, and what light makes of them", false,
               normal_curves_columns, normal_curves_rows});
const Measure spheres =
    old(Legacy{"spheres", "pictures of a smooth and a bumpy sphere by several highlights, and their errors", false,
               spheres_columns, spheres_rows});
const Measure continuity =
    old(Legacy{"continuity", "jumps of the light across the borders of slabs and of the cases of their shading", false,
               continuity_columns, continuity_rows});
const Measure gradient_angles =
    old(Legacy{"gradient_angles", "angles between the normals of consecutive samples, by ways to take gradients", true,
               gradient_angles_columns, gradient_angles_rows});
const Measure slab_shading =
    old(Legacy{"slab_shading", "errors of the light along a slab, by methods, angles and places of the light", false,
               slab_shading_columns, slab_shading_rows});
const Measure clamps =
    old(Legacy{"clamps", "the worst that treatments of negative cosines make of a slab, found by search", false,
               clamps_columns, clamps_rows});
const Measure shading_integrals =
    old(Legacy{"shading_integrals", "errors of the colour of whole slabs, and the share of slabs a method is best on",
               false, shading_integrals_columns, shading_integrals_rows});
const Measure table_resolution =
    old(Legacy{"table_resolution", "errors of look-ups in exact tables against their size, and their orders", false,
               table_resolution_columns, table_resolution_rows});
const Measure table_error_map = old(Legacy{"table_error_map", "where on an exact table look-ups err", false,
                                           table_error_map_columns, table_error_map_rows});
const Measure table_formats =
    old(Legacy{"table_formats", "errors of look-ups by the format of the table and the weights of the texture unit",
               false, table_formats_columns, table_formats_rows});
const Measure second_order_table =
    old(Legacy{"second_order_table", "errors of tables of second order by iterations and size, and what they cost",
               false, second_order_table_columns, second_order_table_rows});
const Measure partial_pre_integration =
    old(Legacy{"partial_pre_integration", "errors of Moreland's partial pre-integration by the size of its table",
               false, partial_pre_integration_columns, partial_pre_integration_rows});

std::span<const Measure* const> measures() {
  static constexpr std::array list{
      &signal_error,
      &cell_cubic,
      &turning_points,
      &orders,
      &virtual_samples,
      &frequency_responses,
      &minmax_bounds,
      &integral_orders,
      &work_precision,
      &iterations,
      &xi_versus_integral,
      &opacity_recursion,
      &opacity_conventions,
      &conformance,
      &reference_proof,
      &table_builds,
      &weighted_tables,
      &distance_axis,
      &eta,
      &cone_lobe,
      &normal_curves,
      &spheres,
      &continuity,
      &gradient_angles,
      &slab_shading,
      &clamps,
      &shading_integrals,
      &gl_functions,
      &gl_rays,
      &table_texture_precision,
      &volume_texture_precision,
      &gl_renderer,
      &table_resolution,
      &table_error_map,
      &table_formats,
      &second_order_table,
      &partial_pre_integration,
      &table_pareto,
      &images,
      &costs,
      &error_waterfall,
      &optimal_table,
  };
  return list;
}

}  // namespace raytruth
