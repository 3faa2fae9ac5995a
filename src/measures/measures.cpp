#include "experiments/measure.hpp"

#include <array>

namespace raytruth {

extern const Measure cone_lobe;
extern const Measure continuity;
extern const Measure distance_axis;
extern const Measure eta;
extern const Measure gradient_angles;
extern const Measure normal_curves;
extern const Measure partial_pre_integration;
extern const Measure second_order_table_measure;
extern const Measure shading_integrals;
extern const Measure slab_shading;
extern const Measure spheres;
extern const Measure table_builds_measure;
extern const Measure table_error_map;
extern const Measure table_formats_measure;
extern const Measure table_pareto;
extern const Measure table_resolution;
extern const Measure turning_points;
extern const Measure weighted_tables_measure;

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

std::vector<Column> clamps_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> clamps_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

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
const Measure clamps =
    old(Legacy{"clamps", "the worst that treatments of negative cosines make of a slab, found by search", false,
               clamps_columns, clamps_rows});
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
      &table_builds_measure,
      &weighted_tables_measure,
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
      &table_formats_measure,
      &second_order_table_measure,
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
