#pragma once

#include "study/experiment.hpp"
#include "study/row.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace raytruth {

/// What an experiment can ask. Adding one: its two functions in a file of its own, and a line in
/// `measures`.
struct Measure {
  std::string_view name;
  std::string_view summary;
  /// Whether it is asked of every field of the experiment, along its rays; else once, with an empty field.
  bool of_fields;
  /// The columns of its rows besides `measure`, `field`, `status` and `why`. Refuses options it does not know.
  std::vector<Column> (*columns)(const Experiment&, const JsonReader& options);
  /// The rows of a field, without `measure` and `field`; without `status` and `why` unless refused; the same bytes on
  /// any number of threads.
  std::vector<Row> (*rows)(const Experiment&, const JsonReader& options, const Field&);
  /// For minutes of work that no fields divide, instead of `rows`: the number of blocks that an interrupted run keeps
  /// once they are done, and the rows of one of them.
  std::int64_t (*blocks)(const JsonReader& options) = nullptr;
  std::vector<Row> (*block_rows)(const Experiment&, const JsonReader& options, std::int64_t block) = nullptr;
  bool uses_gl = false;
  /// What the rows of all fields come to together: rows of no field, behind those.
  std::vector<Row> (*conclusions)(const Experiment&, const JsonReader& options, const std::vector<Row>& rows) = nullptr;
};

/// A measure of fields that concludes something from all of them.
constexpr Measure with_conclusions(Measure measure, decltype(Measure::conclusions) conclusions) {
  measure.conclusions = conclusions;
  return measure;
}

/// A measure that runs shaders.
constexpr Measure with_gl(Measure measure) {
  measure.uses_gl = true;
  return measure;
}

std::vector<Column> signal_error_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> signal_error_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> cell_cubic_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> cell_cubic_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> turning_points_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> turning_points_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

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

std::vector<Column> table_pareto_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> table_pareto_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> slab_shading_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> slab_shading_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> clamps_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> clamps_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

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

inline constexpr std::array measures{
    Measure{"signal_error", "xi and xi_max of every scheme along random rays: quantiles, and ratios between schemes",
            true, signal_error_columns, signal_error_rows},
    Measure{"cell_cubic", "whether a trilinear ray is a cubic inside each cell, and how its slope jumps between cells",
            true, cell_cubic_columns, cell_cubic_rows},
    Measure{"turning_points", "how often the cubic inside a cell turns twice", true, turning_points_columns,
            turning_points_rows},
    Measure{"orders", "fitted orders of xi and xi_max, refined inside cells and at constant steps across them", true,
            orders_columns, orders_rows},
    Measure{"virtual_samples", "RMSE, maximum and PSNR of virtual samples, and of fewer or trilinear ones", true,
            virtual_samples_columns, virtual_samples_rows},
    Measure{"frequency_response", "Fourier transforms of the B-spline and of virtual samples, closed form and measured",
            false, frequency_response_columns, frequency_response_rows},
    Measure{"minmax_bounds", "how far virtual samples leave the range of their data and of the block they lie in",
            false, minmax_bounds_columns, minmax_bounds_rows},
    Measure{"integral_orders", "fitted orders of colour and opacity, refined inside cells and at constant steps", true,
            integral_orders_columns, integral_orders_rows},
    Measure{"work_precision", "errors of colour and opacity by their causes, against what a scheme reads and does",
            true, work_precision_columns, work_precision_rows},
    Measure{"iterations", "errors of slabs that are summed up in N iterations, in steps of an 8-bit frame", true,
            iterations_columns, iterations_rows},
    Measure{"xi_versus_integral", "rank correlation of xi and the errors of colour and opacity", true,
            xi_versus_integral_columns, xi_versus_integral_rows},
    Measure{"opacity_recursion", "the opacity of a part of a stretch by Lee's recursion against the closed form", false,
            opacity_recursion_columns, opacity_recursion_rows},
    Measure{"opacity_conventions", "what it costs to take a table of one convention of opacity for another", true,
            opacity_conventions_columns, opacity_conventions_rows},
    Measure{"conformance", "digits that a scheme's answers to the conformance vectors have right", false,
            conformance_columns, conformance_rows},
    Measure{"reference_proof", "the certified reference against Arb: not one violation of a radius", false,
            reference_proof_columns, nullptr, reference_proof_blocks, reference_proof_rows},
    Measure{"table_builds", "composites and exponentials of table builders, and their differences to exact tables",
            false, table_builds_columns, table_builds_rows},
    Measure{"weighted_tables", "digits that weighted tables lose, as the printed difference and as sums", false,
            weighted_tables_columns, weighted_tables_rows},
    Measure{"distance_axis", "errors of tables for distances 2^j: the interpolation's and the algorithm's", false,
            distance_axis_columns, distance_axis_rows},
    Measure{"eta", "the length and the direction of the normal between two samples, by ways to normalise it", false,
            eta_columns, eta_rows},
    Measure{"cone_lobe", "highlights that stand for the lobe: deviation, energy, threshold", false, cone_lobe_columns,
            cone_lobe_rows},
    Measure{"normal_curves", "curves between two normals, point by point, and what light makes of them", false,
            normal_curves_columns, normal_curves_rows},
    Measure{"spheres", "pictures of a smooth and a bumpy sphere by several highlights, and their errors", false,
            spheres_columns, spheres_rows},
    Measure{"continuity", "jumps of the light across the borders of slabs and of the cases of their shading", false,
            continuity_columns, continuity_rows},
    Measure{"gradient_angles", "angles between the normals of consecutive samples, by ways to take gradients", true,
            gradient_angles_columns, gradient_angles_rows},
    Measure{"slab_shading", "errors of the light along a slab, by methods, angles and places of the light", false,
            slab_shading_columns, slab_shading_rows},
    Measure{"clamps", "the worst that treatments of negative cosines make of a slab, found by search", false,
            clamps_columns, clamps_rows},
    Measure{"shading_integrals", "errors of the colour of whole slabs, and the share of slabs a method is best on",
            false, shading_integrals_columns, shading_integrals_rows},
    with_gl({"gl_functions", "local functions in GLSL, binary32, binary64 and 50 digits, each against the next", false,
             gl_functions_columns, gl_functions_rows}),
    with_gl({"gl_rays", "errors of rays in a shader: of the method, and of each arithmetic down to GLSL", true,
             gl_rays_columns, gl_rays_rows}),
    with_gl({"table_texture_precision", "look-ups of transfer functions and tables, by weights and formats of texels",
             false, table_texture_precision_columns, table_texture_precision_rows}),
    with_gl({"volume_texture_precision", "look-ups of volumes, by weights and formats of texels", true,
             volume_texture_precision_columns, volume_texture_precision_rows}),
    with_gl({"gl_renderer", "images of a hand-written renderer in GLSL, of the CPU, and certified ones", true,
             gl_renderer_columns, gl_renderer_rows}),
    Measure{"table_resolution", "errors of look-ups in exact tables against their size, and their orders", false,
            table_resolution_columns, table_resolution_rows},
    Measure{"table_error_map", "where on an exact table look-ups err", false, table_error_map_columns,
            table_error_map_rows},
    Measure{"table_formats", "errors of look-ups by the format of the table and the weights of the texture unit", false,
            table_formats_columns, table_formats_rows},
    Measure{"second_order_table", "errors of tables of second order by iterations and size, and what they cost", false,
            second_order_table_columns, second_order_table_rows},
    Measure{"partial_pre_integration", "errors of Moreland's partial pre-integration by the size of its table", false,
            partial_pre_integration_columns, partial_pre_integration_rows},
    Measure{"table_pareto", "the smallest table that reaches an accuracy, of all builders, sizes and formats", false,
            table_pareto_columns, table_pareto_rows},
    Measure{"images", "views of volumes in many ways, against the certified image and each other", true, images_columns,
            images_rows},
    Measure{"costs", "ratios of times that the benchmarks' reports hold, each of one run", false, costs_columns,
            costs_rows},
    Measure{"error_waterfall",
            "what each stage of a renderer adds to an image's error, and what their interaction does", true,
            error_waterfall_columns, error_waterfall_rows},
    with_conclusions({"optimal_table", "the smallest table that an image needs, and how well it is predicted", true,
                      optimal_table_columns, optimal_table_rows},
                     optimal_table_conclusions),
};

/// The measure that an item of an experiment's "measures" names. Throws InputError.
const Measure& measure_of(const JsonReader& options);

}  // namespace raytruth
