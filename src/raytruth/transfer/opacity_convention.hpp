#pragma once

namespace raytruth {

// Three ways to say how much a sample hides, all in use, all called opacity: the extinction tau per unit length; the
// opacity a of a stretch of `unit_length`; the opacity of a stretch of another length. rules/opacity_correction.glsl
// holds the formulas that renderers need.

/// a = 1 - exp(-tau length), as -expm1(-tau length). Throws InputError unless both are finite and >= 0.
double opacity_of(double extinction, double length);

/// tau = -ln(1 - a) / length, as -log1p(-a) / length; infinite for a = 1. Throws InputError unless 0 <= a <= 1 and
/// length > 0.
double extinction_of(double opacity, double length);

/// The opacity of a stretch `ratio` times as long, 1 - (1 - a)^ratio, as -expm1(ratio log1p(-a)) (Lee 2010, eq. 9
/// solved). Throws InputError unless 0 <= a <= 1 and ratio > 0.
double corrected_opacity(double opacity, double ratio);

/// The first order of that, min(1, ratio a): what opacity becomes if it is taken for extinction. Throws as above.
double clamped_opacity(double opacity, double ratio);

}  // namespace raytruth
