#pragma once

#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table_cost.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

/// The dissertation's linear tables for several distances d_j = 2^j (sections 5.2.5 and 5.2.6), as they answer for
/// slabs of one length.
enum class DissertationAlgorithm {
  /// Recurrence (5.2.22): C_j(g) = C_(j-1)(g - 1) Theta_j + b_j, from the distance below. The new interval is put in
  /// front of what lies before it, and light that passes it changes its distance.
  text,
  /// Algorithm 2: the same from C_j(g - 1).
  pseudo_code,
  /// Front to back with d = D / |S_b - S_f| fixed, C <- C + T c(S_b), T <- T theta(S_b), exact: entries of the distance
  /// D = |S_b - S_f| d_j, so the length asked lies between two j that are not the same for all entries.
  corrected,
};

/// What is interpolated linearly in the distance, between d_j and d_(j+1), beside the colour.
enum class DistanceInterpolation { opacity, logarithm };  ///< of 1 - opacity: exact, since it is linear in the distance

/// The table of `axes.length`. As printed, Theta_j is the transmittance of the last interval at the distance D = d_j
/// (5.2.23), and b_j (5.2.24) the light of that interval for d = d_j by the trapezoid rule, attenuated from scalar 0
/// on, exp(-omega) taken from the opacities for D = d_j (5.2.19), times the d that stands before the integral (5.2.5).
/// Opacities are closed forms (5.2.3) at every d_j. S_b < S_f is done as its mirror image. Throws InputError as `check`
/// does.
Table<double> dissertation_linear_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                                        DissertationAlgorithm algorithm, DistanceInterpolation interpolation);

/// One composite for each entry off the diagonal and each distance; the exponentials of the opacities at every
/// distance, and of the diagonal.
TableCost dissertation_linear_cost(std::int64_t size);

}  // namespace raytruth
