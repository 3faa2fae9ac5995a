#pragma once

#include "core/chain.hpp"
#include "rules/rules.hpp"
#include "schemes/samples.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace raytruth {

/// A scheme's row in the catalogue: what tables and plots say of it, and what its tests hold it to.
struct SchemeInfo {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  int exact_degree;  ///< polynomials up to this degree are reproduced, the next degree is not
  int order;         ///< xi = O(h^order) where the signal is smooth, sampled at the constant step h
  double error_constant;  ///< xi -> error_constant h^order integral |d^order s / dt^order| dt
  int extra_fetches_per_interval;
  std::string_view color;   ///< of its line in plots (palette of Okabe and Ito, safe for the colour-blind)
  std::string_view marker;  ///< of its points, as matplotlib names it
};

/// A scheme turns samples into an approximate signal: `interval` gives the cubic between sample k and sample k + 1.
/// The signal is passed for schemes that fetch more of it; they say so in `extra_fetches_per_interval`.
template <class S>
concept Scheme = requires(const Chain<3>& signal, const Samples<double>& samples, std::size_t k) {
  { S::info } -> std::convertible_to<SchemeInfo>;
  { S::interval(signal, samples, k) } -> std::same_as<Bernstein<3>>;
};

/// Why the scheme cannot use these samples; empty if it can.
template <Scheme S, class Real>
std::string_view refusal(const Samples<Real>& samples) {
  if constexpr (requires { S::refusal(samples); })
    return S::refusal(samples);
  else
    return {};
}

/// The signal that scheme S makes of the samples; `approximation` is overwritten and keeps its memory.
/// Call only where `refusal` is empty.
template <Scheme S, int Degree, class Real>
void approximate(const Chain<Degree, Real>& signal, const Samples<Real>& samples, Chain<3, Real>& approximation) {
  approximation.pieces.clear();
  approximation.end = signal.end;
  for (std::size_t k = 0; k < samples.interval_count(); ++k)
    approximation.pieces.push_back(
        {samples.positions[k], samples.length_of(k), S::interval(signal, samples, k)});
}

/// How often the scheme reads the signal: the samples, and what it fetches besides.
template <Scheme S, class Real>
std::int64_t fetches(const Samples<Real>& samples) {
  return static_cast<std::int64_t>(samples.positions.size() + samples.interval_count() * S::info.extra_fetches_per_interval);
}

}  // namespace raytruth
