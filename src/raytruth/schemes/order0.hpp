#pragma once

#include "raytruth/schemes/scheme.hpp"

namespace raytruth {

/// Holds the value of the front one between two samples (left Riemann approximation).
struct Order0Left {
  static constexpr SchemeInfo info{.name = "order0_left",
                                   .summary = "front sample held (left Riemann)",
                                   .source = "El Hajjar 2008, section 3.2.1",
                                   .exact_degree = 0,
                                   .order = 1,
                                   .error_constant = 0.5,
                                   .integral_order = 1,
                                   .extra_fetches_per_interval = 0,
                                   .color = "#999999",
                                   .marker = "<"};

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& /*signal*/, const Samples<Real>& samples,
                                     std::size_t k) {
    return Rules<Real>::cubic(Rules<Real>{}.order0(samples.values[k]));
  }
};

/// Holds the value of the back one between two samples (right Riemann approximation).
struct Order0Right {
  static constexpr SchemeInfo info{.name = "order0_right",
                                   .summary = "back sample held (right Riemann)",
                                   .source = "El Hajjar 2008, section 3.2.1",
                                   .exact_degree = 0,
                                   .order = 1,
                                   .error_constant = 0.5,
                                   .integral_order = 1,
                                   .extra_fetches_per_interval = 0,
                                   .color = "#56B4E9",
                                   .marker = ">"};

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& /*signal*/, const Samples<Real>& samples,
                                     std::size_t k) {
    return Rules<Real>::cubic(Rules<Real>{}.order0(samples.values[k + 1]));
  }
};

/// Holds the signal's value at their midpoint, an extra fetch, between two samples.
struct Order0Mid {
  static constexpr SchemeInfo info{.name = "order0_mid",
                                   .summary = "value at the midpoint held",
                                   .source = "El Hajjar 2008, section 3.2.1",
                                   .exact_degree = 0,
                                   .order = 1,
                                   .error_constant = 0.25,
                                   .integral_order = 2,
                                   .extra_fetches_per_interval = 1,
                                   .color = "#E69F00",
                                   .marker = "s"};

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& signal, const Samples<Real>& samples, std::size_t k) {
    const auto middle = samples.positions[k] + Abscissa<Real>(samples.length_of(k) / Real(2));
    return Rules<Real>::cubic(Rules<Real>{}.order0(signal.value(middle)));
  }
};

}  // namespace raytruth
