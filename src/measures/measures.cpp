#include "experiments/measure.hpp"

#include <array>

namespace raytruth {

extern const Measure advise_holds_measure;
extern const Measure cell_cubic_measure;
extern const Measure cell_tables_measure;
extern const Measure cells_against_grid_measure;
extern const Measure clamps_measure;
extern const Measure cone_lobe_measure;
extern const Measure conformance_measure;
extern const Measure continuity_measure;
extern const Measure costs_measure;
extern const Measure cubic_splitting_measure;
extern const Measure distance_axis_measure;
extern const Measure error_waterfall_measure;
extern const Measure eta_measure;
extern const Measure frequency_response_measure;
extern const Measure gl_functions_measure;
extern const Measure gl_rays_measure;
extern const Measure gl_renderer_measure;
extern const Measure gooch_tones_measure;
extern const Measure gradient_angles_measure;
extern const Measure images_measure;
extern const Measure integral_orders_measure;
extern const Measure inverse_deformation_measure;
extern const Measure isosurface_images_measure;
extern const Measure isosurface_jumps_measure;
extern const Measure isosurface_limit_measure;
extern const Measure isosurface_misses_measure;
extern const Measure iterations_measure;
extern const Measure minmax_bounds_measure;
extern const Measure mirrored_gradient_measure;
extern const Measure normal_curves_measure;
extern const Measure opacity_conventions_measure;
extern const Measure opacity_recursion_measure;
extern const Measure optimal_table_measure;
extern const Measure orders_measure;
extern const Measure partial_pre_integration_measure;
extern const Measure paper_identities_measure;
extern const Measure printed_figures_measure;
extern const Measure projected_tetrahedra_measure;
extern const Measure quadratic_gray_fit_measure;
extern const Measure quadratic_r_axis_measure;
extern const Measure quadratic_simpson_measure;
extern const Measure quadratic_slips_measure;
extern const Measure quadratic_table_builds_measure;
extern const Measure reference_proof_measure;
extern const Measure second_order_distance_measure;
extern const Measure second_order_table_measure;
extern const Measure shading_integrals_measure;
extern const Measure signal_error_measure;
extern const Measure slab_shading_measure;
extern const Measure spheres_measure;
extern const Measure table_builds_measure;
extern const Measure table_error_map_measure;
extern const Measure table_formats_measure;
extern const Measure table_pareto_measure;
extern const Measure table_resolution_measure;
extern const Measure table_texture_precision_measure;
extern const Measure turning_points_measure;
extern const Measure virtual_samples_measure;
extern const Measure volume_texture_precision_measure;
extern const Measure weighted_tables_measure;
extern const Measure work_precision_measure;
extern const Measure xi_versus_integral_measure;

std::span<const Measure* const> measures() {
  static constexpr std::array list{
      &signal_error_measure,
      &advise_holds_measure,
      &cell_cubic_measure,
      &turning_points_measure,
      &isosurface_misses_measure,
      &isosurface_limit_measure,
      &isosurface_jumps_measure,
      &quadratic_gray_fit_measure,
      &cubic_splitting_measure,
      &orders_measure,
      &virtual_samples_measure,
      &frequency_response_measure,
      &minmax_bounds_measure,
      &integral_orders_measure,
      &work_precision_measure,
      &iterations_measure,
      &xi_versus_integral_measure,
      &opacity_recursion_measure,
      &opacity_conventions_measure,
      &conformance_measure,
      &reference_proof_measure,
      &table_builds_measure,
      &weighted_tables_measure,
      &quadratic_table_builds_measure,
      &quadratic_simpson_measure,
      &quadratic_r_axis_measure,
      &quadratic_slips_measure,
      &distance_axis_measure,
      &eta_measure,
      &cone_lobe_measure,
      &normal_curves_measure,
      &spheres_measure,
      &continuity_measure,
      &gradient_angles_measure,
      &slab_shading_measure,
      &clamps_measure,
      &mirrored_gradient_measure,
      &inverse_deformation_measure,
      &gooch_tones_measure,
      &shading_integrals_measure,
      &gl_functions_measure,
      &gl_rays_measure,
      &table_texture_precision_measure,
      &volume_texture_precision_measure,
      &gl_renderer_measure,
      &table_resolution_measure,
      &table_error_map_measure,
      &table_formats_measure,
      &second_order_table_measure,
      &second_order_distance_measure,
      &cell_tables_measure,
      &projected_tetrahedra_measure,
      &cells_against_grid_measure,
      &partial_pre_integration_measure,
      &table_pareto_measure,
      &images_measure,
      &isosurface_images_measure,
      &costs_measure,
      &printed_figures_measure,
      &paper_identities_measure,
      &error_waterfall_measure,
      &optimal_table_measure,
  };
  return list;
}

}  // namespace raytruth
