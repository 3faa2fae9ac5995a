#pragma once

#include "raytruth/schemes/order1.hpp"

#include <algorithm>

namespace raytruth {

/// The cubic through the four samples of every three intervals, counted from t = 0. One or two intervals that are left
/// over lie on the cubic through the last four samples, so that the order holds to the end; a shorter last interval is
/// linear, and so is a ray with fewer than three equal intervals.
///
/// Reproduces a trilinear ray where each slab of three intervals stays inside one cell: with `cells` sampling at three
/// intervals per piece, three fetches for each cell and one for the ray's end.
struct Order3 {
  static constexpr SchemeInfo info{.name = "order3",
                                   .summary = "cubic through four equally spaced samples",
                                   .source = "this project; the exact degree of El Hajjar 2008, section 3.1",
                                   .exact_degree = 3,
                                   .order = 4,
                                   .error_constant = 49.0 / 2160,
                                   .integral_order = 4,
                                   .extra_fetches_per_interval = 0,
                                   .color = "#F0E442",
                                   .marker = "v"};

  template <class Real>
  static std::string_view refusal(const Samples<Real>& samples) {
    if (samples.step) return {};
    constexpr std::string_view why = "four equally spaced samples to a slab are needed";
    if (samples.interval_count() % 3 != 0) return why;
    for (std::size_t k = 0; k < samples.interval_count(); k += 3) {
      const auto [low, high] = std::minmax({samples.length_of(k), samples.length_of(k + 1), samples.length_of(k + 2)});
      if (high - low > Real(1e-9) * high) return why;
    }
    return {};
  }

  template <class Real>
  static std::size_t slab_intervals(const Samples<Real>& samples, std::size_t k) {
    return k + 3 <= full_intervals(samples) ? 3 : 1;
  }

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& signal, const Samples<Real>& samples, std::size_t k) {
    const std::size_t full = full_intervals(samples);
    if (k >= full || full < 3) return Order1::interval(signal, samples, k);
    const std::size_t front = std::min(k - k % 3, full - 3);
    const auto* value = samples.values.data() + front;
    Rules<Real> rules;
    if (k == front) return Rules<Real>::cubic(rules.order3_front(value[0], value[1], value[2], value[3]));
    if (k == front + 1) return Rules<Real>::cubic(rules.order3_middle(value[0], value[1], value[2], value[3]));
    return Rules<Real>::cubic(rules.order3_back(value[0], value[1], value[2], value[3]));
  }
};

}  // namespace raytruth
