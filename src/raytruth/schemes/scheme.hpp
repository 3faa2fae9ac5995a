#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/schemes/samples.hpp"

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
  int exact_degree;       ///< polynomials up to this degree are reproduced, the next degree is not
  int order;              ///< xi = O(h^order) where the signal is smooth, sampled at the constant step h
  double error_constant;  ///< xi -> error_constant h^order integral |d^order s / dt^order| dt
  int integral_order;     ///< of colour and opacity, optics smooth too: s - s^ may cancel within a slab
  int extra_fetches_per_interval;
  int parts_per_interval = 1;  ///< of equal length, a cubic each
  std::string_view color;      ///< of its line in plots (palette of Okabe and Ito, safe for the colour-blind)
  std::string_view marker;     ///< of its points, as matplotlib names it
};

template <class S>
concept GivesIntervals = requires(const Chain<3>& signal, const Samples<double>& samples, std::size_t k) {
  { S::interval(signal, samples, k) } -> std::same_as<Bernstein<3>>;
};

template <class S>
concept GivesParts = requires(const Chain<3>& signal, const Samples<double>& samples, std::size_t k, int part) {
  { S::interval(signal, samples, k, part) } -> std::same_as<Bernstein<3>>;
};

template <class S>
concept GivesSlabs = requires(const Chain<3>& signal, const Samples<double>& samples, std::size_t k, Chain<3>& chain) {
  S::append_slab(signal, samples, k, chain);
};

/// A scheme turns samples into an approximate signal: `interval` gives the cubic between sample k and sample k + 1, or
/// on one of its `parts_per_interval` parts, if they are more than one; or `append_slab` appends the pieces of the slab
/// that begins at sample k, which are as many as it needs, and each a look-up. The signal is passed for schemes that
/// fetch more of it; they say so in `extra_fetches_per_interval`.
template <class S>
concept Scheme = std::convertible_to<decltype(S::info), SchemeInfo> &&
    (GivesIntervals<S> || GivesParts<S> || GivesSlabs<S>);

/// Why the scheme cannot use these samples; empty if it can.
template <Scheme S, class Real>
std::string_view refusal(const Samples<Real>& samples) {
  if constexpr (requires { S::refusal(samples); })
    return S::refusal(samples);
  else
    return {};
}

/// How many intervals, from sample k on, are one slab: one look-up in a table of pre-integrated slabs, but for schemes
/// that cut it into parts of their own.
template <Scheme S, class Real>
std::size_t slab_intervals(const Samples<Real>& samples, std::size_t k) {
  if constexpr (requires { S::slab_intervals(samples, k); })
    return S::slab_intervals(samples, k);
  else
    return 1;
}

/// The signal that scheme S makes of the samples; `approximation` is overwritten and keeps its memory.
/// Call only where `refusal` is empty.
template <Scheme S, int Degree, class Real>
void approximate(const Chain<Degree, Real>& signal, const Samples<Real>& samples, Chain<3, Real>& approximation) {
  approximation.pieces.clear();
  approximation.end = signal.end;
  constexpr int parts = S::info.parts_per_interval;
  std::size_t next = 0;
  for (std::size_t k = 0; k < samples.interval_count(); k = next) {
    next = k + 1;
    if constexpr (GivesSlabs<S>) {
      next = k + slab_intervals<S>(samples, k);
      S::append_slab(signal, samples, k, approximation);
    } else if constexpr (parts == 1) {
      approximation.pieces.push_back({samples.positions[k], samples.length_of(k), S::interval(signal, samples, k)});
    } else {
      const Real length = samples.length_of(k) / Real(parts);
      for (int part = 0; part < parts; ++part)
        approximation.pieces.push_back({samples.positions[k] + Abscissa<Real>(Real(part) * length), length,
                                        S::interval(signal, samples, k, part)});
    }
  }
}

/// How often the scheme reads the signal: the samples, and what it fetches besides.
template <Scheme S, class Real>
std::int64_t fetches(const Samples<Real>& samples) {
  return static_cast<std::int64_t>(samples.positions.size() +
                                   samples.interval_count() * S::info.extra_fetches_per_interval);
}

}  // namespace raytruth
