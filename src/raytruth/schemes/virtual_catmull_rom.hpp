#pragma once

#include "raytruth/schemes/scheme.hpp"

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
                                   .integral_order = 4,
                                   .extra_fetches_per_interval = 0,
                                   .color = "#009E73",
                                   .marker = "D"};

  template <class Real>
  static std::string_view refusal(const Samples<Real>& samples) {
    return samples.step ? std::string_view{} : "virtual samples need a constant step";
  }

  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& /*signal*/, const Samples<Real>& samples,
                                     std::size_t k) {
    return Rules<Real>::cubic(curve(samples.values, full_intervals(samples), k));
  }

  /// The cubic from sample k to the next one, of whose intervals the first `full` are equally long.
  template <class Real>
  static typename Rules<Real>::vec4 curve(const std::vector<Real>& value, std::size_t full, std::size_t k) {
    Rules<Real> rules;
    if (k >= full || full < 2) return rules.order1(value[k], value[k + 1]);
    const Real before = k > 0 ? value[k - 1] : rules.virtual_catmull_rom_ghost(value[0], value[1], value[2]);
    const Real after =
        k + 2 <= full ? value[k + 2] : rules.virtual_catmull_rom_ghost(value[full], value[full - 1], value[full - 2]);
    return rules.virtual_catmull_rom(before, value[k], value[k + 1], after);
  }
};

}  // namespace raytruth
