#pragma once

#include "raytruth/transfer/piecewise_linear.hpp"

#include <cstdint>

namespace raytruth {

// The transfer functions of the studies, on scalars in [0, 1], with the largest extinction given; along a ray of a
// length x / extinction the optical depth is at most x. But for `random_transfer` the colour is (s, 1/2, 1 - s), from
// blue to red, so that no two channels ask for the same integral.

/// The extinction rises linearly from 0 at s = 0.
PiecewiseLinear ramp_transfer(double extinction);

/// A tent over 0.5 +- 0.1.
PiecewiseLinear tent_transfer(double extinction);

/// A box over 0.5 +- 1/512: an isosurface one step of 8-bit data thick.
PiecewiseLinear isoslab_transfer(double extinction);

/// Nothing below s = 0.5, the same extinction everywhere from there on.
PiecewiseLinear step_transfer(double extinction);

/// A Gaussian of mean 0.5 and deviation 0.05, linear between 1025 points.
PiecewiseLinear gaussian_transfer(double extinction);

/// Extinction and colour uniform in [0, extinction) and [0, 1) at 256 points s = i / 255, from a counter-based
/// generator: the highest frequency that a table for 8-bit data can hold.
PiecewiseLinear random_transfer(double extinction, std::uint64_t seed);

namespace catalogue {

/// A transfer function of the studies.
struct TransferEntry {
  std::string_view name;
  std::string_view summary;
  PiecewiseLinear (*make)(double extinction, std::uint64_t seed);  ///< null: a file states its points
};

inline constexpr std::array transfers{
    TransferEntry{"points", "piecewise linear between points (s, extinction, color); two points at one s make a jump",
                  nullptr},
    TransferEntry{"ramp", "extinction from 0 at s = 0 to its largest at 1; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return ramp_transfer(extinction); }},
    TransferEntry{"tent", "a tent of extinction over 0.5 +- 0.1; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return tent_transfer(extinction); }},
    TransferEntry{"isoslab", "a box of extinction over 0.5 +- 1/512; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return isoslab_transfer(extinction); }},
    TransferEntry{"step", "no extinction below 0.5, a constant one from there on; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return step_transfer(extinction); }},
    TransferEntry{"gaussian", "extinction a Gaussian of mean 0.5, deviation 0.05, 1025 points; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return gaussian_transfer(extinction); }},
    TransferEntry{"random", "extinction and color random at 256 points, from the seed", random_transfer},
};

}  // namespace catalogue

}  // namespace raytruth
