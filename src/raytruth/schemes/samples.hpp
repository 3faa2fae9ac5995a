#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/real.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace raytruth {

/// The samples of a signal along a ray, in order, from t = 0 to its end; no samples for a ray of length 0.
template <class Real = double>
struct Samples {
  std::vector<Abscissa<Real>> positions;
  std::vector<Real> values;
  std::optional<Real> step;  ///< the constant step, where there is one; the last interval may be shorter

  [[nodiscard]] std::size_t interval_count() const { return positions.empty() ? 0 : positions.size() - 1; }

  /// Length of the interval from sample `interval` to the next.
  [[nodiscard]] Real length_of(std::size_t interval) const {
    return static_cast<Real>(positions[interval + 1] - positions[interval]);
  }

  void clear() {
    positions.clear();
    values.clear();
    step.reset();
  }
};

/// Number of intervals but for a last one that is shorter than the constant step, to the slack of 10^-9 L that constant
/// sampling leaves it.
template <class Real>
std::size_t full_intervals(const Samples<Real>& samples) {
  const std::size_t count = samples.interval_count();
  if (count == 0 || !samples.step) return count;
  const Real slack = Real(1e-9) * static_cast<Real>(samples.positions.back());
  return samples.length_of(count - 1) < *samples.step - slack ? count - 1 : count;
}

/// More samples than this on one ray are refused.
inline constexpr std::int64_t largest_sample_count = 10'000'000;

/// `cells`: the signal at every border of its pieces (for a trilinear ray: of the dual voxels), and inside each piece
/// so that it is divided into equal intervals: two, at its midpoint (El Hajjar 2008, section 3.2), or more. `samples`
/// is overwritten and keeps its memory.
template <int Degree, class Real>
void sample_cells(const Chain<Degree, Real>& signal, Samples<Real>& samples, int intervals_per_piece = 2) {
  samples.clear();
  if (signal.pieces.empty()) return;
  for (const auto& piece : signal.pieces) {
    samples.positions.push_back(piece.start);
    samples.values.push_back(piece.polynomial.coefficients.front());
    for (int i = 1; i < intervals_per_piece; ++i) {
      const Real u = Real(i) / Real(intervals_per_piece);
      samples.positions.push_back(piece.start + Abscissa<Real>(u * piece.length));
      samples.values.push_back(piece.polynomial.value(u));
    }
  }
  samples.positions.push_back(signal.end);
  samples.values.push_back(signal.pieces.back().polynomial.coefficients.back());
}

/// `constant`: the signal at t_i = i h while i h < L (1 - 10^-9), and at L; so the last interval may be shorter.
/// `samples` is overwritten and keeps its memory. Throws InputError for more than 10^7 samples.
template <int Degree, class Real>
void sample_constant(const Chain<Degree, Real>& signal, const Real& step, Samples<Real>& samples) {
  samples.clear();
  samples.step = step;
  if (signal.pieces.empty()) return;
  const Real length = signal.length();
  if (!(length / step < Real(largest_sample_count - 1)))
    throw InputError(fmt::format("step {} on a ray of length {}; steps that make at most {} samples are allowed",
                                 to_double(step), to_double(length), largest_sample_count));
  const Real last = length * (Real(1) - Real(1e-9));
  std::size_t piece = 0;
  for (std::int64_t i = 0;; ++i) {
    const Real t = Real(i) * step;
    if (!(t < last)) break;
    while (piece + 1 < signal.pieces.size() && !(Abscissa<Real>(t) < signal.pieces[piece + 1].start)) ++piece;
    samples.positions.push_back(t);
    samples.values.push_back(signal.pieces[piece].polynomial.value(signal.pieces[piece].local(t)));
  }
  samples.positions.push_back(signal.end);
  samples.values.push_back(signal.pieces.back().polynomial.coefficients.back());
}

/// Samples at this step, or, without one, at the borders of the signal's pieces and at their midpoints.
template <int Degree>
void take_samples(const Chain<Degree>& signal, const std::optional<double>& step, Samples<double>& samples) {
  if (step)
    sample_constant(signal, *step, samples);
  else
    sample_cells(signal, samples);
}

}  // namespace raytruth
