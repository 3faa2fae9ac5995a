// Compiled once for every level of x86-64, with RAYTRUTH_LEVEL naming it.

#include "kernels/cell_kernel.hpp"
#include "kernels/look_up_kernel.hpp"
#include "kernels/moment_kernel.hpp"
#include "kernels/parabola_kernel.hpp"
#include "kernels/piece_kernel.hpp"
#include "kernels/second_order_kernel.hpp"
#include "kernels/stretch_kernel.hpp"
#include "kernels/subrange_kernel.hpp"

namespace raytruth::inline RAYTRUTH_LEVEL {

namespace {

template <int Degree>
LinearPiece<Degree, Lanes> in_lanes(const LinearPiece<Degree, Eight>& pieces) {
  LinearPiece<Degree, Lanes> result;
  for (std::size_t j = 0; j <= Degree; ++j) result.x[j] = Lanes(pieces.x[j]);
  result.x_error = Lanes(pieces.x_error);
  result.extinction_at_0 = Lanes(pieces.extinction_at_0);
  result.extinction_at_1 = Lanes(pieces.extinction_at_1);
  result.length = Lanes(pieces.length);
  return result;
}

template <int Degree>
PieceIntegral<Eight> integrate_eight(const LinearPiece<Degree, Eight>& pieces, bool associated) {
  const PieceIntegral<Lanes> result = integrate_node_by_node(in_lanes(pieces), associated);
  return {Eight(result.weight_0), Eight(result.weight_1),    Eight(result.weight_error),
          Eight(result.depth),    Eight(result.depth_error), Eight(result.nodes)};
}

Eight transmittances(const Eight& depths) { return Eight(exponential(-Lanes(depths))); }

template <int Degree>
constexpr Kernels<Degree> all_of{integrate_nodes_side_by_side<Degree>,
                                 integrate_node_by_node<Degree, double>,
                                 integrate_eight<Degree>,
                                 crossings<Degree>,
                                 normalise<Degree>,
                                 transmittances};

}  // namespace

extern const Kernels<3> kernels_of_3;
extern const Kernels<9> kernels_of_9;
const Kernels<3> kernels_of_3 = all_of<3>;
const Kernels<9> kernels_of_9 = all_of<9>;

extern const TableKernels kernels_of_tables;
const TableKernels kernels_of_tables{float_lane_count, run_band<SlabAlgebra>, run_band<MomentAlgebra>};

extern const SlabKernels kernels_of_slabs;
const SlabKernels kernels_of_slabs{march_four, second_order_row, float_lane_count, parabolas};

extern const CellKernels kernels_of_cells;
const CellKernels kernels_of_cells{integrate_cells};

}  // namespace raytruth::inline RAYTRUTH_LEVEL
