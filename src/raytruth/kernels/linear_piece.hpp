#pragma once

#include "raytruth/kernels/level.hpp"

#include <array>

namespace raytruth {

/// A stretch of a ray on which the transfer function is one linear function: extinction and colour are linear in the
/// normalised scalar x(u), 0 <= u <= 1, a polynomial in Bernstein form. `Vector` is double; or Eight: eight pieces.
template <int Degree, class Vector = double>
struct LinearPiece {
  std::array<Vector, Degree + 1> x{};
  Vector x_error{};          ///< bound on |x(u)| missed, at every u
  Vector extinction_at_0{};  ///< tau where x = 0, >= 0
  Vector extinction_at_1{};  ///< tau where x = 1, >= 0
  Vector length{};           ///< with a relative error of up to 2 units in the last place
};

/// The certified integrals of a piece, T(u) = exp(-length integral_0^u tau):
///
///     weight_0 = length integral (1 - x) r T du,
///     weight_1 = length integral x r T du,
///     depth    = length integral tau du,
///
/// r = tau for associated emission, 1 for plain; so the colour is c_0 weight_0 + c_1 weight_1, c_0 and c_1 those of
/// x = 0 and x = 1.
template <class Vector = double>
struct PieceIntegral {
  Vector weight_0{};
  Vector weight_1{};
  Vector weight_error{};  ///< of each of the two
  Vector depth{};
  Vector depth_error{};
  Vector nodes{};  ///< of the quadrature; above most_nodes: not integrated
};

inline void set_lane(PieceIntegral<Eight>& integrals, std::size_t lane, const PieceIntegral<>& integral) {
  integrals.weight_0[lane] = integral.weight_0;
  integrals.weight_1[lane] = integral.weight_1;
  integrals.weight_error[lane] = integral.weight_error;
  integrals.depth[lane] = integral.depth;
  integrals.depth_error[lane] = integral.depth_error;
  integrals.nodes[lane] = integral.nodes;
}

inline PieceIntegral<> lane_of(const PieceIntegral<Eight>& integrals, std::size_t lane) {
  return {.weight_0 = integrals.weight_0[lane],
          .weight_1 = integrals.weight_1[lane],
          .weight_error = integrals.weight_error[lane],
          .depth = integrals.depth[lane],
          .depth_error = integrals.depth_error[lane],
          .nodes = integrals.nodes[lane]};
}

}  // namespace raytruth
