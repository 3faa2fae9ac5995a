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
};

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
};

/// The measure that an item of an experiment's "measures" names. Throws InputError.
const Measure& measure_of(const JsonReader& options);

}  // namespace raytruth
