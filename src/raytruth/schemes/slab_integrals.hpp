#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/schemes/integral_scheme.hpp"
#include "raytruth/schemes/optics_lookup.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <span>

namespace raytruth {

/// A slab of an approximate signal: consecutive cubics.
using SlabPieces = std::span<const Piece<3>>;

/// integral q dt (three channels) and integral tau dt over the slab, in closed form: split where the signal meets the
/// transfer function's points, tau is linear in s and q linear or quadratic; the means of s and s^2 are those of the
/// Bernstein coefficients. Where the opacity is linear, by quadrature.
Rules<double>::vec4 optics_integral(SlabPieces slab, const PiecewiseLinear& transfer, Emission emission);

/// The slab as a table holds it that neglects self-attenuation: C = integral q dt, A = 1 - exp(-integral tau dt).
Rules<double>::vec4 unattenuated_slab(SlabPieces slab, const PiecewiseLinear& transfer, Emission emission);

/// The slab as El Hajjar 2008 sums it up: N homogeneous steps of equal width, front to back.
Rules<double>::vec4 iterated_slab(SlabPieces slab, const OpticsLookup<double>& look_up, const Iterations& iterations);

}  // namespace raytruth
