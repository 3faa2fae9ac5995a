#pragma once

#include "raytruth/schemes/order1.hpp"
#include "raytruth/schemes/virtual_catmull_rom.hpp"

namespace raytruth {

/// The lines through the true samples and `Count` equally spaced virtual samples in every interval, which are values of
/// Curve's cubic there: what a renderer sees of that cubic at Count + 1 times the sampling rate. It needs a constant
/// step.
template <class Curve, int Count>
struct VirtualSamples {
  template <class Real>
  static std::string_view refusal(const Samples<Real>& samples) {
    if (samples.interval_count() > largest_sample_count / (Count + 1))
      return "with virtual samples there would be more than 10^7 on the ray";
    return VirtualCatmullRom::refusal(samples);
  }

  /// The line on the given one of the interval's Count + 1 parts.
  template <int Degree, class Real>
  static Bernstein<3, Real> interval(const Chain<Degree, Real>& signal, const Samples<Real>& samples, std::size_t k,
                                     int part) {
    const auto& b = Curve::interval(signal, samples, k).coefficients;
    const typename Rules<Real>::vec4 curve(b[0], b[1], b[2], b[3]);
    Rules<Real> rules;
    // True samples are taken as they are, so that parts and intervals meet bit by bit.
    const auto sample = [&](int i) -> Real {
      if (i == 0) return curve[0];
      if (i == Count + 1) return curve[3];
      return rules.virtual_sample(curve, Real(i) / Real(Count + 1));
    };
    return Rules<Real>::cubic(rules.order1(sample(part), sample(part + 1)));
  }

 protected:
  /// The row of the catalogue, but for what the curve says.
  static constexpr SchemeInfo info_of(std::string_view name, std::string_view summary, std::string_view source,
                                      double error_constant, std::string_view color) {
    return {.name = name,
            .summary = summary,
            .source = source,
            .exact_degree = 1,
            .order = 2,
            .error_constant = error_constant,
            .integral_order = 2,
            .extra_fetches_per_interval = 0,
            .parts_per_interval = Count + 1,
            .color = color,
            .marker = Count == 1   ? "d"
                      : Count == 3 ? "P"
                                   : "X"};
  }
};

/// Virtual samples on the Catmull-Rom cubic: its error, of third order, does not show beside that of the lines between
/// the samples.
template <int Count>
struct VirtualCatmullRomSamples : VirtualSamples<VirtualCatmullRom, Count> {
 protected:
  static constexpr SchemeInfo info_of(std::string_view name, std::string_view summary) {
    return VirtualSamples<VirtualCatmullRom, Count>::info_of(name, summary, "Lee 2010, section 3.1",
                                                             1.0 / (12 * (Count + 1) * (Count + 1)), "#009E73");
  }
};

/// Virtual samples on the chord: order 1 at more samples.
template <int Count>
struct VirtualLinearSamples : VirtualSamples<Order1, Count> {
 protected:
  static constexpr SchemeInfo info_of(std::string_view name, std::string_view summary) {
    return VirtualSamples<Order1, Count>::info_of(name, summary, "Lee 2010, section 5.1", 1.0 / 12, "#CC79A7");
  }
};

struct VirtualCatmullRom1 : VirtualCatmullRomSamples<1> {
  static constexpr SchemeInfo info =
      info_of("virtual_catmull_rom_1", "linear, with a virtual Catmull-Rom sample between");
};

struct VirtualCatmullRom3 : VirtualCatmullRomSamples<3> {
  static constexpr SchemeInfo info =
      info_of("virtual_catmull_rom_3", "linear, with 3 virtual Catmull-Rom samples between");
};

struct VirtualCatmullRom7 : VirtualCatmullRomSamples<7> {
  static constexpr SchemeInfo info =
      info_of("virtual_catmull_rom_7", "linear, with 7 virtual Catmull-Rom samples between");
};

struct VirtualLinear1 : VirtualLinearSamples<1> {
  static constexpr SchemeInfo info = info_of("virtual_linear_1", "linear, with a virtual sample on the line between");
};

struct VirtualLinear3 : VirtualLinearSamples<3> {
  static constexpr SchemeInfo info = info_of("virtual_linear_3", "linear, with 3 virtual samples on the line between");
};

struct VirtualLinear7 : VirtualLinearSamples<7> {
  static constexpr SchemeInfo info = info_of("virtual_linear_7", "linear, with 7 virtual samples on the line between");
};

}  // namespace raytruth
