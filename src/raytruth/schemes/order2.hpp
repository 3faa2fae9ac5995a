#pragma once

#include "raytruth/schemes/order1.hpp"

namespace raytruth {

/// The parabola through the three samples of each pair of intervals, pairs counted from t = 0, at the samples' true
/// abscissae; a last interval without a partner is linear.
struct Order2 {
  static constexpr SchemeInfo info{.name = "order2",
                                   .summary = "parabola through three samples (Simpson)",
                                   .source = "El Hajjar 2008, section 4, eq. 2",
                                   .exact_degree = 2,
                                   .order = 3,
                                   .error_constant = 1.0 / 24,
                                   .integral_order = 4,
                                   .extra_fetches_per_interval = 0,
                                   .color = "#D55E00",
                                   .marker = "^"};

  template <class Real>
  static std::size_t slab_intervals(const Samples<Real>& samples, std::size_t k) {
    return k + 2 <= samples.interval_count() ? 2 : 1;
  }

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& signal, const Samples<Real>& samples, std::size_t k) {
    const std::size_t front = k - k % 2;
    if (slab_intervals(samples, front) == 1) return Order1::interval(signal, samples, k);
    const auto& value = samples.values;
    const Real front_length = samples.length_of(front);
    const Real split = front_length / (front_length + samples.length_of(front + 1));
    Rules<Real> rules;
    return Rules<Real>::cubic(k == front ? rules.order2_front(value[front], value[front + 1], value[front + 2], split)
                                         : rules.order2_back(value[front], value[front + 1], value[front + 2], split));
  }
};

}  // namespace raytruth
