#pragma once

#include "raytruth/schemes/scheme.hpp"

namespace raytruth {

/// The line between two samples.
struct Order1 {
  static constexpr SchemeInfo info{.name = "order1",
                                   .summary = "linear between samples (trapezoid)",
                                   .source = "El Hajjar 2008, section 3.2.2",
                                   .exact_degree = 1,
                                   .order = 2,
                                   .error_constant = 1.0 / 12,
                                   .integral_order = 2,
                                   .extra_fetches_per_interval = 0,
                                   .color = "#0072B2",
                                   .marker = "o"};

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& /*signal*/, const Samples<Real>& samples,
                                     std::size_t k) {
    return Rules<Real>::cubic(Rules<Real>{}.order1(samples.values[k], samples.values[k + 1]));
  }
};

}  // namespace raytruth
