#include "experiments/measure.hpp"

#include <array>

namespace raytruth {

extern const Measure clamps;
extern const Measure table_pareto;
extern const Measure turning_points;

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

std::vector<Column> signal_error_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> signal_error_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> cell_cubic_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> cell_cubic_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> orders_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> orders_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> virtual_samples_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> virtual_samples_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> frequency_response_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> frequency_response_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> minmax_bounds_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> minmax_bounds_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> integral_orders_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> integral_orders_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> work_precision_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> work_precision_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> iterations_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> iterations_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> xi_versus_integral_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> xi_versus_integral_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> opacity_recursion_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> opacity_recursion_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> opacity_conventions_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> opacity_conventions_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> conformance_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> conformance_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> reference_proof_columns(const Experiment& experiment, const JsonReader& options);
std::int64_t reference_proof_blocks(const JsonReader& options);
std::vector<Row> reference_proof_rows(const Experiment& experiment, const JsonReader& options, std::int64_t block);

std::vector<Column> gl_functions_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> gl_functions_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> gl_rays_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> gl_rays_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> table_texture_precision_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> table_texture_precision_rows(const Experiment& experiment, const JsonReader& options,
                                              const Field& field);

std::vector<Column> volume_texture_precision_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> volume_texture_precision_rows(const Experiment& experiment, const JsonReader& options,
                                               const Field& field);

std::vector<Column> gl_renderer_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> gl_renderer_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

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

std::vector<Column> shading_integrals_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> shading_integrals_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> images_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> images_rows(const Experiment& experiment, const JsonReader& json, const Field& field);

std::vector<Column> costs_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> costs_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> error_waterfall_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> error_waterfall_rows(const Experiment& experiment, const JsonReader& json, const Field& field);

std::vector<Column> optimal_table_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> optimal_table_rows(const Experiment& experiment, const JsonReader& json, const Field& field);
std::vector<Row> optimal_table_conclusions(const Experiment& experiment, const JsonReader& json,
                                           const std::vector<Row>& rows_of_fields);

const Measure signal_error =
    old(Legacy{"signal_error", "xi and xi_max of every scheme along random rays: quantiles, and ratios between schemes",
               true, signal_error_columns, signal_error_rows});
const Measure cell_cubic = old(
    Legacy{"cell_cubic", "whether a trilinear ray is a cubic inside each cell, and how its slope jumps between cells",
           true, cell_cubic_columns, cell_cubic_rows});
const Measure orders =
    old(Legacy{"orders", "fitted orders of xi and xi_max, refined inside cells and at constant steps across them", true,
               orders_columns, orders_rows});
const Measure virtual_samples =
    old(Legacy{"virtual_samples", "RMSE, maximum and PSNR of virtual samples, and of fewer or trilinear ones", true,
               virtual_samples_columns, virtual_samples_rows});
const Measure frequency_response = old(
    Legacy{"frequency_response", "Fourier transforms of the B-spline and of virtual samples, closed form and measured",
           false, frequency_response_columns, frequency_response_rows});
const Measure minmax_bounds =
    old(Legacy{"minmax_bounds", "how far virtual samples leave the range of their data and of the block they lie in",
               false, minmax_bounds_columns, minmax_bounds_rows});
const Measure integral_orders =
    old(Legacy{"integral_orders", "fitted orders of colour and opacity, refined inside cells and at constant steps",
               true, integral_orders_columns, integral_orders_rows});
const Measure work_precision =
    old(Legacy{"work_precision", "errors of colour and opacity by their causes, against what a scheme reads and does",
               true, work_precision_columns, work_precision_rows});
const Measure iterations =
    old(Legacy{"iterations", "errors of slabs that are summed up in N iterations, in steps of an 8-bit frame", true,
               iterations_columns, iterations_rows});
const Measure xi_versus_integral =
    old(Legacy{"xi_versus_integral", "rank correlation of xi and the errors of colour and opacity", true,
               xi_versus_integral_columns, xi_versus_integral_rows});
const Measure opacity_recursion =
    old(Legacy{"opacity_recursion", "the opacity of a part of a stretch by Lee's recursion against the closed form",
               false, opacity_recursion_columns, opacity_recursion_rows});
const Measure opacity_conventions =
    old(Legacy{"opacity_conventions", "what it costs to take a table of one convention of opacity for another", true,
               opacity_conventions_columns, opacity_conventions_rows});
const Measure conformance =
    old(Legacy{"conformance", "digits that a scheme's answers to the conformance vectors have right", false,
               conformance_columns, conformance_rows});
const Measure reference_proof =
    old(Legacy{"reference_proof", "the certified reference against Arb: not one violation of a radius", false,
               reference_proof_columns, nullptr, reference_proof_blocks, reference_proof_rows});
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
const Measure shading_integrals =
    old(Legacy{"shading_integrals", "errors of the colour of whole slabs, and the share of slabs a method is best on",
               false, shading_integrals_columns, shading_integrals_rows});
const Measure gl_functions =
    old(with_gl({"gl_functions", "local functions in GLSL, binary32, binary64 and 50 digits, each against the next",
                 false, gl_functions_columns, gl_functions_rows}));
const Measure gl_rays =
    old(with_gl({"gl_rays", "errors of rays in a shader: of the method, and of each arithmetic down to GLSL", true,
                 gl_rays_columns, gl_rays_rows}));
const Measure table_texture_precision = old(
    with_gl({"table_texture_precision", "look-ups of transfer functions and tables, by weights and formats of texels",
             false, table_texture_precision_columns, table_texture_precision_rows}));
const Measure volume_texture_precision =
    old(with_gl({"volume_texture_precision", "look-ups of volumes, by weights and formats of texels", true,
                 volume_texture_precision_columns, volume_texture_precision_rows}));
const Measure gl_renderer =
    old(with_gl({"gl_renderer", "images of a hand-written renderer in GLSL, of the CPU, and certified ones", true,
                 gl_renderer_columns, gl_renderer_rows}));
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
const Measure images = old(Legacy{"images", "views of volumes in many ways, against the certified image and each other",
                                  true, images_columns, images_rows});
const Measure costs = old(Legacy{"costs", "ratios of times that the benchmarks' reports hold, each of one run", false,
                                 costs_columns, costs_rows});
const Measure error_waterfall = old(
    Legacy{"error_waterfall", "what each stage of a renderer adds to an image's error, and what their interaction does",
           true, error_waterfall_columns, error_waterfall_rows});
const Measure optimal_table =
    old(with_conclusions({"optimal_table", "the smallest table that an image needs, and how well it is predicted", true,
                          optimal_table_columns, optimal_table_rows},
                         optimal_table_conclusions));

std::span<const Measure* const> measures() {
  static constexpr std::array list{
      &signal_error,
      &cell_cubic,
      &turning_points,
      &orders,
      &virtual_samples,
      &frequency_response,
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
