#pragma once

#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/transfer/emission.hpp"

#include <array>

namespace raytruth {

/// What shading by a cubic in s asks of a slab (Guetat 2010, sections 5.1 and 5.2), s from 0 at its front to 1 at its
/// back, with the light's density q and the optical depth sigma from the front:
///
///     I_k  = length integral_0^1 q s^k exp(-sigma(s)) ds,   I'_k the same of white: q = tau (associated) or 1 (plain),
///     I''  = length integral_0^1 (s < 1/2 ? 2 s : 2 - 2 s) q_white exp(-sigma(s)) ds.
struct MomentTables {
  std::array<Table<double>, 4> moments;  ///< k = 0 to 3: RGB I_k, and I'_k as the fourth channel
  Table<double> tent;                    ///< I'' in three channels, and the slab's opacity
};

/// I_k (RGB) and I'_k of a homogeneous slab.
std::array<Eigen::Array<double, 4, 1>, 4> homogeneous_moments(const Optics& optics, Emission emission, double length);

/// All of them in O(n^2), by subranges of slabs that carry their moments about the front:
///
///     M_k(ab) = M_k(a) + T_a sum over p of binomial(k, p) len_a^(k-p) M_p(b),
///
/// sums of what is never negative. The middle of a slab of odd width lies inside an interval: I'' is made of the ranges
/// of half intervals before and behind the middle. A homogeneous interval has the moments of exponential_moments.hpp,
/// so slabs of one colour and extinction are exact, and the others are as exact as `interval_means` makes them. Throws
/// InputError as `check` does.
MomentTables moment_tables(const DiscreteTransfer& transfer, const TableAxes& axes);

}  // namespace raytruth
