#pragma once

// The explorer's engine: one ray, one transfer function and one row of samples, and what every scheme makes of them,
// for a page's script. Plain numbers go in and JSON comes out; a text is good until the next call. What is refused is
// {"error": "..."}, one line.

extern "C" {

/// The schemes in the order of the catalogue: [{"name", "summary", "source", "family", "color"}, ...].
const char* explorer_schemes();

/// The signal becomes that of a ray through `size[0]` x `size[1]` x `size[2]` voxels, x fastest, that are interpolated
/// trilinearly. `ray`: origin and direction in voxels, and the length. Gives {"length"}, of what of it is inside.
const char* explorer_trilinear(const int* size, const double* voxels, const double* ray);

/// The signal becomes that of a ray through the Marschner-Lobb signal, sampled at `samples`^3 nodes and interpolated.
const char* explorer_marschner_lobb(int samples, const double* ray);

/// The signal becomes a polynomial on each of `pieces` intervals: `breaks` are one more, and each piece has `count`
/// coefficients in ascending powers of t - its break.
const char* explorer_polynomials(int pieces, const double* breaks, int count, const double* coefficients);

/// The transfer function becomes that of `count` points, each five numbers: s, extinction, red, green, blue; where
/// `unit_length` is not 0 the second one is the opacity of that length. `is_plain`: emission is not multiplied by the
/// extinction.
const char* explorer_transfer(int count, const double* points, double unit_length, int is_plain);

/// The certified colour and what every scheme makes of samples at t = 0, `phase` h, (1 + `phase`) h, ... and at the
/// end, h being `step` and 0 <= `phase` < 1:
///     {"length", "breaks", "samples": [[t, s], ...], "reference": {"color", "opacity", "error_bound", "converged"},
///      "schemes": {name: {"color", "opacity", "error_bound", "signal", "quadrature", "samples", "lookups"}, ...}}
/// `signal` and `quadrature` are the two parts of the error, [red, green, blue, opacity] each. A scheme that cannot use
/// these samples is {"why": "..."}.
const char* explorer_answer(double step, double phase);

/// The signal and what a scheme takes it for, at `count` + 1 equally spaced places: {"signal": [...], "approximation":
/// [...], "xi"}. `approximation` is empty for schemes without one that is drawn, or where they refuse the samples. At a
/// jump both have the value from the right.
const char* explorer_curves(const char* scheme, double step, double phase, int count);
}
