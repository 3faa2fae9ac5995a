#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/schemes/integral_scheme.hpp"
#include "raytruth/schemes/omissions.hpp"
#include "raytruth/schemes/optics_lookup.hpp"
#include "raytruth/schemes/outcome.hpp"
#include "raytruth/schemes/quadratic_gray.hpp"
#include "raytruth/schemes/quadratic_gray_printed.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/transfer/emission.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace raytruth {

/// A signed difference of two results.
struct Difference {
  Vector3<double> color = Vector3<double>::Constant(0);
  double opacity = 0;
};

/// Where a scheme's error comes from; signal + quadrature + round32 = total, but for the rounding of these sums.
struct ErrorBudget {
  Difference signal;                  ///< its approximate signal integrated exactly - the truth
  Difference quadrature;              ///< the scheme in binary64 - that integral; 0 for schemes that integrate exactly
  std::optional<Difference> round32;  ///< the scheme in binary32 - in binary64; none but for sampled schemes
  Difference total;                   ///< the scheme, in binary32 if there is `round32`, - the truth
  double radius = 0;                  ///< bounds what the two certified integrals add to any of these differences
  Outcome<> outcome;                  ///< the scheme in binary64, its counts, and why it is refused
};

/// Every scheme under one transfer function:
///
///     SchemeIntegral integrate(transfer, Emission::associated);
///     Outcome<> outcome = integrate(*find_named(catalogue::integral_schemes(), "order2"), signal, samples);
///
/// Holds buffers, so that the second ray allocates little: one object per thread.
class SchemeIntegral {
 public:
  SchemeIntegral(const PiecewiseLinear& transfer, Emission emission);

  /// What the scheme makes of these samples of the signal, a chain of degree 3 or 9 (`largest_degree`). Its `omissions`
  /// are left out; the counts are those of the whole ray even so, and an exact integral has no radius then.
  template <int Degree>
  Outcome<> operator()(const IntegralScheme& scheme, const Chain<Degree>& signal, const Samples<double>& samples,
                       const Omissions& omissions = {});

  /// The outcome in binary32, with samples, step and transfer function rounded to it; none but for sampled schemes.
  template <int Degree>
  std::optional<Outcome<>> in_binary32(const IntegralScheme& scheme, const Chain<Degree>& signal,
                                       const Samples<double>& samples);

  /// The error against the truth of the signal, by its causes; only `outcome` is filled in if the scheme is refused.
  template <int Degree>
  ErrorBudget budget(const IntegralScheme& scheme, const Chain<Degree>& signal, const Samples<double>& samples,
                     const Certified& truth);

 private:
  /// The approximate signal of a scheme of catalogue::Schemes, in `approximation_`.
  struct Approximation {
    std::int64_t fetches = 0;
    std::vector<std::size_t> slabs = {};  ///< the first piece of each, and the number of pieces
    std::string_view refusal = {};
  };
  template <int Degree>
  Approximation approximate_by(std::string_view name, const Chain<Degree>& signal, const Samples<double>& samples);

  static Approximation one_slab_per_piece(const Chain<3>& signal, std::int64_t fetches);

  /// The slabs of the approximate signal, each made by `slab_of`, front to back.
  template <class SlabOf>
  Outcome<> composite(const Approximation& approximation, const Omissions& omissions, SlabOf&& slab_of) const;

  /// The approximate signal, integrated exactly.
  Outcome<> integrate_exactly(const Approximation& approximation, const Omissions& omissions);

  template <int Degree>
  Outcome<> integrate(const Sampled& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                      const Samples<double>& samples, const Omissions& omissions);
  template <int Degree>
  Outcome<> integrate(const Ideal& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                      const Samples<double>& samples, const Omissions& omissions);
  template <int Degree>
  Outcome<> integrate(const WithoutAttenuation& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                      const Samples<double>& samples, const Omissions& omissions);
  template <int Degree>
  Outcome<> integrate(const Iterations& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                      const Samples<double>& samples, const Omissions& omissions);
  template <int Degree>
  Outcome<> integrate(const CellCubic& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                      const Samples<double>& samples, const Omissions& omissions);
  template <int Degree>
  Outcome<> integrate(const CellAdaptive& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                      const Samples<double>& samples, const Omissions& omissions);

  template <int Degree>
  Outcome<> integrate(const QuadraticGrayModel& method, const IntegralScheme& scheme, const Chain<Degree>& signal,
                      const Samples<double>& samples, const Omissions& omissions);
  template <int Degree>
  Outcome<> integrate(const QuadraticGrayPrintedModel& method, const IntegralScheme& scheme,
                      const Chain<Degree>& signal, const Samples<double>& samples, const Omissions& omissions);

  PiecewiseLinear transfer_;
  Emission emission_;
  std::optional<QuadraticGraySlabs> quadratic_gray_;  ///< none where the opacity is linear
  std::optional<QuadraticGrayPrinted> printed_;       ///< of the last length of slabs that was asked for
  RayIntegral exact_;
  OpticsLookup<double> look_up_;
  OpticsLookup<Binary32> look_up_in_binary32_;
  Chain<3> approximation_;
  Chain<3> slab_;
};

}  // namespace raytruth
