#include "raytruth/metrics/frequency_response.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/schemes/scheme.hpp"
#include "raytruth/schemes/virtual_catmull_rom.hpp"
#include "raytruth/signals/tricubic.hpp"

#include <fmt/format.h>
#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace raytruth {

namespace {

using Complex = std::complex<double>;

constexpr double pi = std::numbers::pi;

/// Voxels on either side of the impulse: a prefiltered impulse decays by 2 - sqrt(3) per voxel, here to 10^-18.
constexpr std::int64_t half_width = 32;

double sinc(double f) { return f == 0 ? 1 : boost::math::sin_pi(f) / (pi * f); }

/// e^{-2 pi i f x}.
Complex wave(double f, double x) { return {boost::math::cos_pi(2 * f * x), -boost::math::sin_pi(2 * f * x)}; }

/// The cubic B-spline at x.
double bspline(double x) {
  const auto distance = std::abs(x);
  const double outer = 2 - distance;
  if (outer <= 0) return 0;
  const double inner = std::max(1 - distance, 0.0);
  return (outer * outer * outer - 4 * inner * inner * inner) / 6;
}

/// The transform of the B-spline's samples at k + phase.
Complex sampled_bspline(double phase, double f) {
  Complex sum;
  const double first = phase - std::floor(phase) - 2;
  for (int k = 0; k <= 4; ++k) sum += bspline(first + k) * wave(f, first + k);
  return sum;
}

Chain<9> trace_impulse(const ReconstructionPath& path) {
  Grid grid{.size = {2 * half_width + 1, 1, 1}, .spacing = {1, 1, 1}, .values = {}};
  grid.values.assign(2 * half_width + 1, 0.0);
  grid.values[half_width] = 1;
  if (path.prefiltered) grid = bspline_coefficients(grid);
  // Whole steps from sample to sample, the last one included.
  const double phase = path.virtual_phase.value_or(0);
  Chain<9> chain;
  trace_tricubic(grid, CubicKernel::bspline,
                 {.origin = {phase, 0, 0}, .direction = {1, 0, 0}, .length = 2 * half_width - std::ceil(phase)}, chain);
  return chain;
}

/// Bound on the variation of g'' from before the chain, where it is 0, to after it: that of the control polygons.
template <int Degree>
double curvature_variation(const Chain<Degree>& chain) {
  double variation = 0;
  double before = 0;
  for (const auto& piece : chain.pieces) {
    const auto curvature = piece.polynomial.derivative().derivative();
    for (const double b : curvature.coefficients) {
      const double here = b / (piece.length * piece.length);
      variation += std::abs(here - before);
      before = here;
    }
  }
  return variation + std::abs(before);
}

double alias_bound(double variation, int samples_per_voxel) {
  constexpr double zeta_3 = 1.2020569031595943;
  const double least = 2 * pi * (samples_per_voxel - 2);
  return 2 * zeta_3 * variation / (least * least * least);
}

}  // namespace

Complex frequency_response(const ReconstructionPath& path, double f) {
  const double s = sinc(f);
  const double prefilter = path.prefiltered ? 3 / (2 + boost::math::cos_pi(2 * f)) : 1;
  if (!path.virtual_phase) return prefilter * s * s * s * s;
  const double catmull_rom = s * s * s * (3 * s - 2 * boost::math::cos_pi(f));
  return prefilter * catmull_rom * sampled_bspline(*path.virtual_phase, f);
}

ImpulseResponse::ImpulseResponse(const ReconstructionPath& path, int samples_per_voxel)
    : first_(path.virtual_phase.value_or(0) - half_width), step_(1.0 / samples_per_voxel) {
  if (samples_per_voxel <= 2)
    throw InputError(fmt::format("{} samples per voxel; at least 3 are allowed", samples_per_voxel));
  const Chain<9> signal = trace_impulse(path);
  Samples<double> fine;
  double variation = 0;
  if (path.virtual_phase) {
    Samples<double> samples;
    sample_constant(signal, 1.0, samples);
    Chain<3> approximation;
    approximate<VirtualCatmullRom>(signal, samples, approximation);
    sample_constant(approximation, step_, fine);
    variation = curvature_variation(approximation);
  } else {
    sample_constant(signal, step_, fine);
    variation = curvature_variation(signal);
  }
  values_ = std::move(fine.values);
  double magnitude = 0;
  for (const double value : values_) magnitude += step_ * std::abs(value);
  radius_ = 8 * static_cast<double>(values_.size()) * std::numeric_limits<double>::epsilon() * magnitude;
  aliases_ = alias_bound(variation, samples_per_voxel);
}

Complex ImpulseResponse::at(double frequency) const {
  const Complex turn = wave(frequency, step_);
  const auto horner = [&turn](const Complex& sum, double value) { return sum * turn + value; };
  const Complex sum = std::accumulate(values_.rbegin(), values_.rend(), Complex(), horner);
  return step_ * sum * wave(frequency, first_);
}

}  // namespace raytruth
