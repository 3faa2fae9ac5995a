// Compiled once for every level of x86-64, with RAYTRUTH_LEVEL naming it.

#include "raytruth/kernels/cell_kernel.hpp"
#include "raytruth/kernels/diagonal_kernel.hpp"
#include "raytruth/kernels/look_up_kernel.hpp"
#include "raytruth/kernels/moment_kernel.hpp"
#include "raytruth/kernels/opacity_kernel.hpp"
#include "raytruth/kernels/parabola_kernel.hpp"
#include "raytruth/kernels/piece_kernel.hpp"
#include "raytruth/kernels/second_order_kernel.hpp"
#include "raytruth/kernels/stretch_kernel.hpp"
#include "raytruth/kernels/subrange_kernel.hpp"

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

PieceIntegral<Eight> in_memory(const PieceIntegral<Lanes>& integrals) {
  return {Eight(integrals.weight_0), Eight(integrals.weight_1),    Eight(integrals.weight_error),
          Eight(integrals.depth),    Eight(integrals.depth_error), Eight(integrals.nodes)};
}

template <int Degree>
[[gnu::flatten]] PieceIntegral<Eight> integrate_eight(const LinearPiece<Degree, Eight>& pieces, bool associated) {
  return in_memory(associated ? integrate_node_by_node<AssociatedSums>(in_lanes(pieces))
                              : integrate_node_by_node<PlainSums>(in_lanes(pieces)));
}

template <int Degree>
PieceIntegral<> integrate_one(const LinearPiece<Degree>& piece, bool associated) {
  return associated ? integrate_nodes_side_by_side<AssociatedSums>(piece)
                    : integrate_nodes_side_by_side<PlainSums>(piece);
}

template <int Degree>
PieceIntegral<> integrate_scalar(const LinearPiece<Degree>& piece, bool associated) {
  return associated ? integrate_node_by_node<AssociatedSums>(piece) : integrate_node_by_node<PlainSums>(piece);
}

template <int Degree>
OpacityPiece<Degree, Lanes> in_lanes(const OpacityPiece<Degree, Eight>& pieces) {
  OpacityPiece<Degree, Lanes> result;
  for (std::size_t j = 0; j <= Degree; ++j) {
    result.x[j] = Lanes(pieces.x[j]);
    result.opacity[j] = Lanes(pieces.opacity[j]);
    result.clear[j] = Lanes(pieces.clear[j]);
  }
  result.x_error = Lanes(pieces.x_error);
  result.clear_error = Lanes(pieces.clear_error);
  result.length = Lanes(pieces.length);
  result.units = Lanes(pieces.units);
  return result;
}

template <int Degree>
[[gnu::flatten]] PieceIntegral<Eight> integrate_eight_opacities(const OpacityPiece<Degree, Eight>& pieces,
                                                                bool associated) {
  return in_memory(integrate_opacity(in_lanes(pieces), associated));
}

template <int Degree>
PieceIntegral<> integrate_one_opacity(const OpacityPiece<Degree>& piece, bool associated) {
  return integrate_opacity(piece, associated);
}

Eight transmittances(const Eight& depths) { return Eight(exponential(-Lanes(depths))); }

template <int Degree>
constexpr Kernels<Degree> all_of{integrate_one<Degree>,
                                 integrate_scalar<Degree>,
                                 integrate_eight<Degree>,
                                 integrate_one_opacity<Degree>,
                                 integrate_eight_opacities<Degree>,
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
const SlabKernels kernels_of_slabs{march_four, second_order_row, float_lane_count,
                                   parabolas,  diagonal_slabs,   diagonal_opacities};

extern const CellKernels kernels_of_cells;
const CellKernels kernels_of_cells{integrate_cells};

}  // namespace raytruth::inline RAYTRUTH_LEVEL
