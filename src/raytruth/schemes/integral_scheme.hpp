#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>

namespace raytruth {

/// Where a sampled scheme looks the transfer function up in a slab, and how it sums up what it finds there.
enum class SampledRule {
  riemann_left,         ///< the slab has the optics of its front sample
  riemann_right,        ///< of its back sample
  riemann_mid,          ///< of its midpoint, the only place that is read
  trapezoid,            ///< rules/trapezoid.glsl, between two samples
  simpson,              ///< rules/simpson.glsl, over three samples; an unpaired last slab by the trapezoid rule
  virtual_catmull_rom,  ///< riemann_left at true and virtual samples, opacity corrected to their distance
};

/// How much of its optical depth a homogeneous stretch of a ray absorbs.
enum class Absorption {
  exponential,  ///< 1 - exp(-D)
  linear,       ///< min(1, D), as early renderers had it: first order only
};

/// How virtual samples get the opacity of their shorter step from that of the sampling step.
enum class OpacityCorrection {
  closed_form,  ///< 1 - (1 - a)^(1/n)
  recursion,    ///< Lee 2010, eq. 11: log2(n) square roots
};

/// Post-classification: samples are looked up in the transfer function and composited.
struct Sampled {
  SampledRule rule{};
  Absorption absorption = Absorption::exponential;
  int virtual_samples = 0;  ///< per interval, for virtual_catmull_rom: 2^m - 1
  OpacityCorrection correction = OpacityCorrection::closed_form;
};

/// Pre-integration without a table's limits: the approximate signal integrated exactly.
struct Ideal {};

/// Pre-integration that attenuates no light on its way out of a slab: C = integral q dt, the opacity as it is (Engel,
/// Kraus and Ertl 2001, section 3.2, as El Hajjar 2008 tells it).
struct WithoutAttenuation {};

/// The table's entries as El Hajjar 2008 (section 7) sums them up: `count` homogeneous steps of a slab, with the optics
/// at (k + 1/2) / count, or at k / count if `is_left`.
struct Iterations {
  int count = 0;
  bool is_left = false;
};

/// The signal itself, cell by cell, from the eight voxels of each.
struct CellCubic {};

/// Samples at cell borders and, as many as the budget leaves, inside the longest chords: `distribute_fetches`.
struct CellAdaptive {};

/// The slabs of `order2` in the coordinates of the dissertation's quadratic gray-value model, exactly
/// (schemes/quadratic_gray.hpp).
struct QuadraticGrayModel {};

/// This model as it is printed, its gray values 0 to 255 being the scalars from the transfer function's first point
/// to its last one (schemes/quadratic_gray_printed.hpp).
struct QuadraticGrayPrintedModel {};

using Method = std::variant<Sampled, Ideal, WithoutAttenuation, Iterations, CellCubic, CellAdaptive, QuadraticGrayModel,
                            QuadraticGrayPrintedModel>;

/// The slope of log error over log step where signal and transfer function are smooth, at equal steps whose number is a
/// multiple of 6 (pairs and triples come out even); 0: the scheme has no step to have an order in.
///
/// For ideal schemes the order is one more than that of xi where s - s^ is odd about the middle of every slab to
/// leading order (order0_mid, order2, virtual_catmull_rom but for two intervals): to first order in s - s^ the error is
/// its integral under a smooth weight, and only the part of the weight's slope is left, smaller by one power of the
/// step.
struct IntegralOrder {
  int color = 0;
  int opacity = 0;
};

/// A way from samples and a transfer function to the colour and the opacity of a ray: a row of the catalogue.
/// `SchemeIntegral` does what it says.
struct IntegralScheme {
  std::string name = {};
  std::string summary = {};
  std::string_view source = {};
  Method method = {};
  std::string_view signal =
      {};  ///< scheme of catalogue::Schemes whose approximate signal it integrates; empty: its own
  IntegralOrder order = {};
  bool is_exact_on_constants = true;  ///< a constant signal gives the closed form
  std::string_view color = {};        ///< of its line in plots
  std::string_view marker = {};       ///< of its points, as matplotlib names it
};

/// `sampled`, `ideal`, `no_attenuation`, `iterations`, `exact` or `printed`: the family in tables and plots.
inline std::string_view family(const IntegralScheme& scheme) {
  constexpr std::array<std::string_view, std::variant_size_v<Method>> names{
      "sampled", "ideal", "no_attenuation", "iterations", "exact", "exact", "ideal", "printed"};
  return names[scheme.method.index()];
}

/// Whether the approximate signal is integrated exactly, so that its error is that of the signal alone.
inline bool is_exact(const IntegralScheme& scheme) {
  return std::holds_alternative<Ideal>(scheme.method) || std::holds_alternative<CellCubic>(scheme.method) ||
         std::holds_alternative<CellAdaptive>(scheme.method) ||
         std::holds_alternative<QuadraticGrayModel>(scheme.method);
}

}  // namespace raytruth
