#include "raytruth/schemes/scheme_integral.hpp"

#include "raytruth/reference/certified.hpp"
#include "raytruth/schemes/cell_adaptive.hpp"
#include "raytruth/schemes/sampled_march.hpp"
#include "raytruth/schemes/scheme_list.hpp"
#include "raytruth/schemes/slab_integrals.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/transfer/emission.hpp"

#include <cmath>
#include <numeric>

namespace raytruth {

namespace {

Outcome<> refused(std::string_view why) {
  Outcome<> outcome;
  outcome.refusal = why;
  return outcome;
}

Outcome<> outcome_of(const Certified& integral) {
  Outcome<> outcome;
  outcome.color = integral.color;
  outcome.opacity = integral.opacity;
  outcome.radius = integral.radius;
  outcome.status = integral.status;
  return outcome;
}

/// Why the scheme of catalogue::Schemes cannot use these samples; empty if it can.
std::string_view refusal_of(std::string_view signal, const Samples<double>& samples) {
  std::string_view why;
  catalogue::visit_scheme(signal, [&]<class S>() { why = refusal<S>(samples); });
  return why;
}

/// The outcome with its counts: what it read were samples.
Outcome<> counted(Outcome<> outcome, std::int64_t fetches, std::size_t slabs) {
  outcome.fetches = fetches;
  outcome.voxels = voxels_per_fetch * fetches;
  outcome.lookups = static_cast<std::int64_t>(slabs);
  outcome.composites = static_cast<std::int64_t>(slabs);
  return outcome;
}

/// A slab of `order2`: the parabola of one or two pieces.
struct ParabolicSlab {
  double front = 0;
  double back = 0;
  double curvature = 0;  ///< second divided difference, per squared length
  double length = 0;
};

ParabolicSlab parabola_of(SlabPieces pieces) {
  const auto& first = pieces.front();
  const auto& last = pieces.back();
  ParabolicSlab slab{.front = first.polynomial.coefficients.front(),
                     .back = last.polynomial.coefficients.back(),
                     .length = first.length};
  if (pieces.size() == 1) return slab;
  slab.length += last.length;
  slab.curvature = Rules<double>{}.order2_curvature(slab.front, last.polynomial.coefficients.front(), slab.back,
                                                    first.length / slab.length) /
                   (slab.length * slab.length);
  return slab;
}

template <class A, class B>
Difference difference(const A& a, const B& b) {
  return {a.color - b.color, a.opacity - b.opacity};
}

bool is_finite(const Outcome<>& outcome) { return outcome.color.isFinite().all() && std::isfinite(outcome.opacity); }

}  // namespace

SchemeIntegral::SchemeIntegral(const PiecewiseLinear& transfer, Emission emission)
    : transfer_(transfer),
      emission_(emission),
      exact_(transfer, emission),
      look_up_(transfer, emission),
      look_up_in_binary32_(transfer, emission) {
  if (!transfer.is_linear_in_opacity()) quadratic_gray_.emplace(transfer, emission);
}

template <int Degree>
SchemeIntegral::Approximation SchemeIntegral::approximate_by(std::string_view name, const Chain<Degree>& signal,
                                                             const Samples<double>& samples) {
  Approximation result{.refusal = refusal_of(name, samples)};
  if (!result.refusal.empty()) return result;
  catalogue::visit_scheme(name, [&]<class S>() {
    approximate<S>(signal, samples, approximation_);
    result.fetches = fetches<S>(samples);
    if constexpr (GivesSlabs<S>) {
      result.slabs = one_slab_per_piece(approximation_, 0).slabs;
      return;
    }
    constexpr std::size_t parts = S::info.parts_per_interval;
    for (std::size_t k = 0; k < samples.interval_count(); k += slab_intervals<S>(samples, k))
      for (std::size_t part = 0; part < parts; ++part) result.slabs.push_back(k * parts + part);
    result.slabs.push_back(approximation_.pieces.size());
  });
  return result;
}

SchemeIntegral::Approximation SchemeIntegral::one_slab_per_piece(const Chain<3>& signal, std::int64_t fetches) {
  Approximation result{.fetches = fetches, .slabs = std::vector<std::size_t>(signal.pieces.size() + 1)};
  std::iota(result.slabs.begin(), result.slabs.end(), std::size_t{0});
  return result;
}

template <class SlabOf>
Outcome<> SchemeIntegral::composite(const Approximation& approximation, const Omissions& omissions,
                                    SlabOf&& slab_of) const {
  Rules<double> rules;
  Rules<double>::vec4 ray = Rules<double>::vec4::Constant(0);
  for (std::size_t i = 0; i + 1 < approximation.slabs.size() && ray[3] < omissions.opaque; ++i) {
    const std::size_t first = approximation.slabs[i];
    const std::size_t next = approximation.slabs[i + 1];
    const auto& pieces = approximation_.pieces;
    if (omissions.omit(static_cast<double>(pieces[first].start), static_cast<double>(approximation_.end_of(next - 1))))
      continue;
    ray = rules.over(ray, slab_of(SlabPieces(pieces.data() + first, next - first)));
  }
  Outcome<> outcome;
  outcome.color = ray.head<3>();
  outcome.opacity = ray[3];
  return counted(outcome, approximation.fetches, approximation.slabs.size() - 1);
}

Outcome<> SchemeIntegral::integrate_exactly(const Approximation& approximation, const Omissions& omissions) {
  if (omissions.are_none())
    return counted(outcome_of(exact_(approximation_)), approximation.fetches, approximation.slabs.size() - 1);
  return composite(approximation, omissions, [this](SlabPieces pieces) {
    slab_.pieces.assign(pieces.begin(), pieces.end());
    slab_.end = pieces.back().start + DoubleDouble(pieces.back().length);
    return exact_(slab_).rgba();
  });
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const Sampled& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                                    const Samples<double>& samples, const Omissions& omissions) {
  if (const auto why = refusal_of(scheme.signal, samples); !why.empty()) return refused(why);
  return march(method, look_up_, SampledRay<double>(signal, samples), omissions);
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const Ideal& /*method*/, const IntegralScheme& scheme, const Chain<Degree>& signal,
                                    const Samples<double>& samples, const Omissions& omissions) {
  const Approximation approximation = approximate_by(scheme.signal, signal, samples);
  if (!approximation.refusal.empty()) return refused(approximation.refusal);
  return integrate_exactly(approximation, omissions);
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const WithoutAttenuation& /*method*/, const IntegralScheme& scheme,
                                    const Chain<Degree>& signal, const Samples<double>& samples,
                                    const Omissions& omissions) {
  const Approximation approximation = approximate_by(scheme.signal, signal, samples);
  if (!approximation.refusal.empty()) return refused(approximation.refusal);
  return composite(approximation, omissions,
                   [&](SlabPieces slab) { return unattenuated_slab(slab, transfer_, emission_); });
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const Iterations& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                                    const Samples<double>& samples, const Omissions& omissions) {
  const Approximation approximation = approximate_by(scheme.signal, signal, samples);
  if (!approximation.refusal.empty()) return refused(approximation.refusal);
  return composite(approximation, omissions, [&](SlabPieces slab) { return iterated_slab(slab, look_up_, method); });
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const CellCubic& /*method*/, const IntegralScheme& /*scheme*/,
                                    const Chain<Degree>& signal, const Samples<double>& /*samples*/,
                                    const Omissions& omissions) {
  if constexpr (Degree == 3) {
    approximation_ = signal;
    const auto cells = static_cast<std::int64_t>(signal.pieces.size());
    Outcome<> outcome = integrate_exactly(one_slab_per_piece(signal, voxels_per_fetch * cells), omissions);
    outcome.voxels = voxels_per_fetch * cells;
    return outcome;
  } else {
    return refused("a trilinear ray, a cubic in each cell, is needed");
  }
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const CellAdaptive& /*method*/, const IntegralScheme& /*scheme*/,
                                    const Chain<Degree>& signal, const Samples<double>& samples,
                                    const Omissions& omissions) {
  const std::int64_t fetches =
      approximate_cells(signal, static_cast<std::int64_t>(samples.positions.size()), approximation_);
  Outcome<> outcome = integrate_exactly(one_slab_per_piece(approximation_, fetches), omissions);
  outcome.lookups = outcome.composites = static_cast<std::int64_t>(signal.pieces.size());
  return outcome;
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const QuadraticGrayModel& /*method*/, const IntegralScheme& scheme,
                                    const Chain<Degree>& signal, const Samples<double>& samples,
                                    const Omissions& omissions) {
  const Approximation approximation = approximate_by(scheme.signal, signal, samples);
  if (!approximation.refusal.empty()) return refused(approximation.refusal);
  if (!quadratic_gray_) return integrate_exactly(approximation, omissions);
  return composite(approximation, omissions, [&](SlabPieces pieces) {
    const ParabolicSlab slab = parabola_of(pieces);
    return (*quadratic_gray_)(QuadraticGray::of_curvature(slab.front, slab.back, slab.curvature, slab.length));
  });
}

template <int Degree>
Outcome<> SchemeIntegral::integrate(const QuadraticGrayPrintedModel& /*method*/, const IntegralScheme& scheme,
                                    const Chain<Degree>& signal, const Samples<double>& samples,
                                    const Omissions& omissions) {
  if (!quadratic_gray_) return refused("a transfer function that is linear in extinction is needed");
  const double low = transfer_.points().front().s;
  const double high = transfer_.points().back().s;
  if (low == high) return refused("a transfer function with points at two scalars is needed, gray values 0 and 255");
  const Approximation approximation = approximate_by(scheme.signal, signal, samples);
  if (!approximation.refusal.empty()) return refused(approximation.refusal);
  return composite(approximation, omissions, [&](SlabPieces pieces) {
    const ParabolicSlab slab = parabola_of(pieces);
    // Steps of one length differ by the rounding of their positions.
    if (!printed_ || std::abs(printed_->length() - slab.length) > 1e-9 * slab.length)
      printed_.emplace(transfer_, low, high, slab.length, emission_);
    return (*printed_)(slab.front, slab.back, slab.curvature);
  });
}

template <int Degree>
Outcome<> SchemeIntegral::operator()(const IntegralScheme& scheme, const Chain<Degree>& signal,
                                     const Samples<double>& samples, const Omissions& omissions) {
  Outcome<> outcome = std::visit(
      [&](const auto& method) { return integrate(method, scheme, signal, samples, omissions); }, scheme.method);
  return is_finite(outcome) ? outcome : refused("its result is beyond the range of binary64");
}

template <int Degree>
std::optional<Outcome<>> SchemeIntegral::in_binary32(const IntegralScheme& scheme, const Chain<Degree>& signal,
                                                     const Samples<double>& samples) {
  const auto* method = std::get_if<Sampled>(&scheme.method);
  if (method == nullptr) return std::nullopt;
  if (const auto why = refusal_of(scheme.signal, samples); !why.empty()) return refused(why);
  const Outcome<Binary32> low = march(*method, look_up_in_binary32_, SampledRay<Binary32>(signal, samples));
  Outcome<> outcome;
  for (int channel = 0; channel < 3; ++channel) outcome.color[channel] = to_double(low.color[channel]);
  outcome.opacity = to_double(low.opacity);
  outcome.fetches = low.fetches;
  outcome.voxels = low.voxels;
  outcome.lookups = low.lookups;
  outcome.composites = low.composites;
  return is_finite(outcome) ? outcome : refused("its result is beyond the range of binary32");
}

template <int Degree>
ErrorBudget SchemeIntegral::budget(const IntegralScheme& scheme, const Chain<Degree>& signal,
                                   const Samples<double>& samples, const Certified& truth) {
  ErrorBudget result;
  result.outcome = (*this)(scheme, signal, samples);
  if (!result.outcome.refusal.empty()) return result;
  result.total = difference(result.outcome, truth);
  result.radius = truth.radius + result.outcome.radius;
  if (is_exact(scheme)) {
    result.signal = result.total;
    return result;
  }
  approximate_by(scheme.signal, signal, samples);
  const Certified ideal = exact_(approximation_);
  result.radius = truth.radius + ideal.radius;
  result.signal = difference(ideal, truth);
  result.quadrature = difference(result.outcome, ideal);
  const auto low = in_binary32(scheme, signal, samples);
  if (low && low->refusal.empty()) {
    result.round32 = difference(*low, result.outcome);
    result.total = difference(*low, truth);
  }
  return result;
}

template Outcome<> SchemeIntegral::operator()(const IntegralScheme&, const Chain<3>&, const Samples<double>&,
                                              const Omissions&);
template Outcome<> SchemeIntegral::operator()(const IntegralScheme&, const Chain<largest_degree>&,
                                              const Samples<double>&, const Omissions&);
template std::optional<Outcome<>> SchemeIntegral::in_binary32(const IntegralScheme&, const Chain<3>&,
                                                              const Samples<double>&);
template std::optional<Outcome<>> SchemeIntegral::in_binary32(const IntegralScheme&, const Chain<largest_degree>&,
                                                              const Samples<double>&);
template ErrorBudget SchemeIntegral::budget(const IntegralScheme&, const Chain<3>&, const Samples<double>&,
                                            const Certified&);
template ErrorBudget SchemeIntegral::budget(const IntegralScheme&, const Chain<largest_degree>&, const Samples<double>&,
                                            const Certified&);

}  // namespace raytruth
