#pragma once

#include "schemes/order1.hpp"

namespace raytruth {

/// The Catmull-Rom cubic through equally spaced samples, with ghost samples beyond both ends; a shorter last interval
/// is linear, and so is a ray with fewer than three equally spaced samples.
struct VirtualCatmullRom {
  static constexpr SchemeInfo info{.name = "virtual_catmull_rom",
                                   .summary = "Catmull-Rom cubic through equally spaced samples",
                                   .source = "Lee 2010, section 3.2",
                                   .exact_degree = 2,
                                   .order = 3,
                                   .error_constant = 1.0 / 96,
                                   .extra_fetches_per_interval = 0,
                                   .color = "#009E73",
                                   .marker = "D"};

  template <class Real>
  static std::string_view refusal(const Samples<Real>& samples) {
    return samples.step ? std::string_view{} : "virtual samples need a constant step";
  }

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& signal, const Samples<Real>& samples, std::size_t k) {
    const std::size_t full = full_intervals(samples);
    if (k >= full || full < 2) return Order1::interval(signal, samples, k);
    const auto& value = samples.values;
    Rules<Real> rules;
    const Real before = k > 0 ? value[k - 1] : rules.virtual_catmull_rom_ghost(value[0], value[1], value[2]);
    const Real after =
        k + 2 <= full ? value[k + 2] : rules.virtual_catmull_rom_ghost(value[full], value[full - 1], value[full - 2]);
    return Rules<Real>::cubic(rules.virtual_catmull_rom(before, value[k], value[k + 1], after));
  }

 private:
  /// Number of intervals of full length, to the slack of 10^-9 L that constant sampling leaves the last one.
  template <class Real>
  static std::size_t full_intervals(const Samples<Real>& samples) {
    const std::size_t count = samples.interval_count();
    if (count == 0) return 0;
    const Real slack = Real(1e-9) * static_cast<Real>(samples.positions.back());
    return samples.length_of(count - 1) < samples.step.value_or(Real(0)) - slack ? count - 1 : count;
  }
};

}  // namespace raytruth
