#include "raytruth/reference/arb_integral.hpp"

#include "raytruth/reference/arb/arb_complex.hpp"
#include "raytruth/reference/arb/arb_stretches.hpp"

#include <acb_calc.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace raytruth {

namespace {

using arb::Ball;
using arb::BallPiece;
using arb::BallStretch;
using arb::Color;
using arb::evaluate;
using arb::Polynomial;

// Bits of the quadrature, of its polynomials and of its goal: some decimal digits more than binary64 holds.
constexpr slong quadrature_precision = 96;
constexpr slong polynomial_bits = 80;
constexpr slong quadrature_goal = 60;

/// p(z) exp(-depth(z)), with midpoints only, so that it is holomorphic.
struct Integrand {
  Polynomial factor;
  Polynomial depth;
  std::int64_t evaluations = 0;
};

int integrand(acb_ptr result, const acb_t z, void* parameter, slong /*order*/, slong bits) {
  auto& [factor, depth, evaluations] = *static_cast<Integrand*>(parameter);
  ++evaluations;
  acb_t value;
  acb_init(value);
  evaluate(value, depth, z, bits);
  acb_neg(value, value);
  acb_exp(value, value, bits);
  evaluate(result, factor, z, bits);
  acb_mul(result, result, value, bits);
  acb_clear(value);
  return 0;
}

/// The integral of factor exp(-depth) over [0, 1], the depth being 0 at 0; `scale`: of its value.
///
/// The polynomials' midpoints F, D are integrated. What they enclose is f and d >= 0 with |f - F| <= f', |d - D| <= d',
/// and
///     |f exp(-d) - F exp(-D)| <= f' exp(-d) + |F| exp(-d) |1 - exp(d - D)| <= f' + |F| (exp(d') - 1).
Ball integral(const Polynomial& whole_factor, const Polynomial& whole_depth, const Ball& scale,
              std::int64_t& evaluations) {
  const Polynomial factor = whole_factor.trimmed(polynomial_bits);
  const Polynomial depth = whole_depth.trimmed(polynomial_bits);
  Integrand parameter{factor.middle(), depth.middle()};
  acb_t begin;
  acb_t end;
  acb_t sum;
  mag_t tolerance;
  acb_init(begin);
  acb_init(end);
  acb_init(sum);
  mag_init(tolerance);
  acb_one(end);
  arb_get_mag(tolerance, scale.get());
  mag_mul_2exp_si(tolerance, tolerance, -quadrature_goal);
  acb_calc_integrate(sum, integrand, &parameter, begin, end, quadrature_goal, tolerance, nullptr, quadrature_precision);
  Ball result;
  arb_set(result.get(), acb_realref(sum));
  mag_clear(tolerance);
  acb_clear(sum);
  acb_clear(end);
  acb_clear(begin);
  evaluations += parameter.evaluations;
  return widened(result, factor.error() + parameter.factor.magnitude() * expm1(depth.error()));
}

/// exp(-p(y)) on [-1, 1], p(0) = 0: its series about 0. The terms left out sum up to at most those of
/// exp(sum |p_k| y^k), whose coefficients are positive and no smaller. Nothing where that is too much.
std::optional<Polynomial> exponential(const Polynomial& p) {
  // The costs of longer series and of more parts balance about here.
  constexpr slong terms = 32;
  Polynomial magnitudes;
  Polynomial negative;
  for (slong k = 1; k < p.size(); ++k) {
    magnitudes.set(k, p.coefficient(k).magnitude());
    negative.set(k, -p.coefficient(k));
  }
  const Ball whole = magnitudes(1.0);
  if (!(whole < Ball(8.0))) return {};
  Polynomial majorant;
  arb_poly_exp_series(majorant.get(), magnitudes.get(), terms, arb::precision);
  const Ball rest = max(0.0, exp(whole) - majorant(1.0)).upper();
  if (!(rest < Ball(0x1p-80))) return {};
  Polynomial result;
  arb_poly_exp_series(result.get(), negative.get(), terms, arb::precision);
  result.set(0, widened(result.coefficient(0), rest));
  return result;
}

/// The integral of p(y) over [-1, 1], where what p stands for may be anywhere in its coefficients' balls at every y.
Ball integral_about_0(const Polynomial& p) {
  Ball sum;
  for (slong k = 0; k < p.size(); ++k) {
    const Ball share = Ball(2.0) / Ball(static_cast<double>(k + 1));
    const Ball coefficient = p.coefficient(k);
    sum += k % 2 == 0 ? share * coefficient : widened(Ball(), share * coefficient.radius());
  }
  return sum;
}

/// Adds the integrals of each factor times exp(-depth) over middle - half ... middle + half, of series.
void add_integrals(const std::array<Polynomial, 2>& factors, const Polynomial& depth, const Ball& middle,
                   const Ball& half, std::array<Ball, 2>& sums) {
  Polynomial from_middle = depth.restricted(middle, middle + half);
  const Ball front = exp(-from_middle.coefficient(0));
  from_middle.set(0, 0.0);
  if (const auto transmittance = exponential(from_middle)) {
    for (std::size_t i = 0; i < factors.size(); ++i)
      if (factors[i].size() > 0)
        sums[i] += half * front * integral_about_0(factors[i].restricted(middle, middle + half) * *transmittance);
    return;
  }
  const Ball quarter = half / 2;
  add_integrals(factors, depth, middle - quarter, quarter, sums);
  add_integrals(factors, depth, middle + quarter, quarter, sums);
}

/// The integrals of each factor times exp(-depth) over [0, 1], the depth being 0 at 0; `scale`: of their values.
std::array<Ball, 2> integrals(const std::array<Polynomial, 2>& factors, const Polynomial& depth, const Ball& scale,
                              std::int64_t& evaluations) {
  // Above it the quadrature is faster: it need not look at what is hidden.
  constexpr double most_of_series = 32;
  std::array<Ball, 2> sums;
  const Polynomial short_depth = depth.trimmed(polynomial_bits);
  if (short_depth.magnitude() < Ball(most_of_series)) {
    std::array<Polynomial, 2> short_factors;
    for (std::size_t i = 0; i < factors.size(); ++i) short_factors[i] = factors[i].trimmed(polynomial_bits);
    add_integrals(short_factors, short_depth, 0.5, 0.5, sums);
  } else {
    for (std::size_t i = 0; i < factors.size(); ++i)
      if (factors[i].size() > 0) sums[i] = integral(factors[i], depth, scale, evaluations);
  }
  return sums;
}

/// (1 - exp(-depth)) / depth for depth >= 0.
Ball mean_transmittance(const Ball& depth) {
  if (depth.sign() > 0) return -expm1(-depth) / depth;
  return hull(1.0, exp(-depth));
}

/// What a stretch sends to its front, and its optical depth.
struct StretchLight {
  Color color;
  Ball depth;
};

/// The light of a stretch of which no more than its optical depth is known.
StretchLight integrate_enclosed(const BallStretch& stretch, Emission emission) {
  const Ball total = *stretch.depth;
  const Ball opacity = max(0.0, min(1.0, -expm1(-total)));
  const bool is_opaque = Ball(arb::opaque_depth) <= total;
  Ball emitted = opacity;
  if (emission == Emission::plain)
    emitted = is_opaque ? Ball() : stretch.length * hull(max(0.0, min(1.0, exp(-total))), 1.0);
  const Ball weight = stretch.weight(hull(Ball(0.0), Ball(1.0)));
  StretchLight light{.color = {}, .depth = total};
  for (std::size_t i = 0; i < 3; ++i) light.color[i] = (stretch.color[i] + stretch.color_change[i] * weight) * emitted;
  return light;
}

StretchLight integrate(const BallStretch& stretch, Emission emission, std::int64_t& evaluations) {
  if (stretch.depth) return integrate_enclosed(stretch, emission);
  const Polynomial depth = stretch.length * stretch.extinction.antiderivative();
  const Ball total = depth(1.0);
  const Ball opacity = -expm1(-total);
  const bool is_associated = emission == Emission::associated;
  const bool is_homogeneous = stretch.extinction.size() <= 1;

  // The integrals of q T, for a colour of 1 and for a colour of the weight.
  const Polynomial density = is_associated ? stretch.length * stretch.extinction : Polynomial(stretch.length);
  const Ball scale = is_associated ? opacity : Ball(1.0) < total ? stretch.length / total : stretch.length;
  const auto is_zero = [](const Ball& x) { return arb_is_zero(x.get()) != 0; };
  const auto& change = stretch.color_change;
  const bool is_one_color = std::all_of(change.begin(), change.end(), is_zero);
  const bool is_closed = is_associated || is_homogeneous;
  const auto [by_parts, of_weight] =
      integrals({is_closed ? Polynomial() : density, is_one_color ? Polynomial() : stretch.weight * density}, depth,
                scale, evaluations);
  const Ball of_one = is_associated ? opacity : is_homogeneous ? stretch.length * mean_transmittance(total) : by_parts;
  StretchLight light{.color = {}, .depth = total};
  for (std::size_t i = 0; i < 3; ++i) light.color[i] = stretch.color[i] * of_one + change[i] * of_weight;
  return light;
}

/// The nearest binary64 number; `radius` grows to its distance from the ball's far end.
double rounded(const Ball& value, double& radius) {
  if (arb_is_finite(value.get()) == 0) {
    radius = std::numeric_limits<double>::infinity();
    return 0;
  }
  const double result = value.nearest();
  radius = std::max(radius, (value - Ball(result)).magnitude().upper_double());
  return result;
}

/// A bound on the signal, its last piece's end included: behind 1 by a rounding, a sum of magnitudes grows by less.
Ball largest_signal(const std::vector<BallPiece>& pieces) {
  Ball largest;
  for (const BallPiece& piece : pieces)
    for (const Ball& s : piece.control) largest = max(largest, s.magnitude());
  return largest * 1.0625;
}

template <class Cut>
Certified certify(const std::vector<BallPiece>& pieces, const Cut& cut, Emission emission, double tolerance) {
  Ball length;
  for (const BallPiece& piece : pieces) length += piece.length * piece.end;
  const Ball brightest = cut.largest_color(largest_signal(pieces));
  const Ball largest = max(1.0, emission == Emission::associated ? brightest : brightest * length).upper();

  Certified result;
  Color color;
  Ball depth;
  Ball opacity;
  for (const BallPiece& piece : pieces) {
    cut(piece, [&](const BallStretch& stretch) {
      const Ball front = exp(-depth);
      const StretchLight light = integrate(stretch, emission, result.evaluations);
      for (std::size_t i = 0; i < 3; ++i) color[i] += front * light.color[i];
      depth += light.depth;
    });
    opacity = -expm1(-depth);
    // Nothing behind shows any more: it sends at most `hidden`, and the opacity is at least what it is here.
    const Ball hidden = exp(-depth) * largest;
    if (hidden < Ball(0x1p-80)) {
      for (Ball& channel : color) channel = widened(channel, hidden.upper());
      opacity = hull(opacity, 1.0);
      break;
    }
  }
  double& radius = result.radius;
  for (std::size_t i = 0; i < 3; ++i) result.color[static_cast<Eigen::Index>(i)] = rounded(color[i], radius);
  result.opacity = rounded(opacity, radius);
  if (!(radius <= tolerance * largest.upper_double())) result.status = Status::not_converged;
  return result;
}

arb::PointsCut cut_by(const PiecewiseLinear& transfer) { return arb::PointsCut(transfer); }
arb::GaussianCut cut_by(const GaussianTransfer& transfer) { return arb::GaussianCut(transfer); }

}  // namespace

template <class Signal, class Transfer>
Certified arb_integral(const Signal& signal, const Transfer& transfer, Emission emission, double tolerance) {
  return certify(arb::pieces_of(signal), cut_by(transfer), emission, tolerance);
}

template Certified arb_integral(const Chain<3>&, const PiecewiseLinear&, Emission, double);
template Certified arb_integral(const Chain<9>&, const PiecewiseLinear&, Emission, double);
template Certified arb_integral(const MarschnerLobbRay&, const PiecewiseLinear&, Emission, double);
template Certified arb_integral(const AnalyticSignal&, const PiecewiseLinear&, Emission, double);
template Certified arb_integral(const Chain<3>&, const GaussianTransfer&, Emission, double);
template Certified arb_integral(const Chain<9>&, const GaussianTransfer&, Emission, double);
template Certified arb_integral(const MarschnerLobbRay&, const GaussianTransfer&, Emission, double);
template Certified arb_integral(const AnalyticSignal&, const GaussianTransfer&, Emission, double);

}  // namespace raytruth
