#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/signals/analytic.hpp"
#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/gaussian_transfer.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

namespace raytruth {

/// The volume rendering integral (`RayIntegral`) by ball arithmetic in 128 bits, whatever the signal and the transfer
/// function: Arb's certified integration (F. Johansson, Numerical integration in arbitrary-precision ball arithmetic,
/// 2018) between the points where the signal meets the transfer function's points. It shares no step with RayIntegral,
/// and is its proof; slower by orders of magnitude.
///
/// Signals: Chain<3>, Chain<9>, MarschnerLobbRay, AnalyticSignal; transfer functions: PiecewiseLinear,
/// GaussianTransfer. What is no polynomial becomes Taylor's polynomials with enclosed remainders. The exact value is
/// that of
///  * chains: the polynomial of a piece's binary64 coefficients and length, from its start (a double-double) to the
///    next piece's;
///  * Marschner-Lobb: the ray of the given origin and the given direction, normalised exactly, clipped exactly;
///  * analytic signals: their formula with the true pi, and every other constant as the binary64 number that the
///    formula in analytic.cpp holds.
/// A radius above `tolerance` max(1, largest colour, length for `plain`) makes the status not_converged. Throws
/// InputError for an analytic signal that it does not know, a direction that is zero, or a deviation that is not > 0.
template <class Signal, class Transfer>
Certified arb_integral(const Signal& signal, const Transfer& transfer, Emission emission, double tolerance = 1e-13);

}  // namespace raytruth
