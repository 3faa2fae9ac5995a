#include "raytruth/schemes/slab_integrals.hpp"

#include <boost/math/quadrature/tanh_sinh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

/// The mean of p^2 on [0, 1]: B_i B_j = binomial(3, i) binomial(3, j) / binomial(6, i + j) times B_(i+j) of degree 6,
/// whose mean is 1/7 (G. Farin, Curves and Surfaces for CAGD, section 6.10).
double mean_square(const Bernstein<3>& p) {
  constexpr std::array<double, 4> binomial_3{1, 3, 3, 1};
  constexpr std::array<double, 7> binomial_6{1, 6, 15, 20, 15, 6, 1};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      sum += binomial_3[i] * binomial_3[j] / binomial_6[i + j] * (p.coefficients[i] * p.coefficients[j]);
  return sum / 7;
}

Vec4 emission_and_extinction(const Optics& optics, Emission emission) {
  const Vector3<double> q =
      emission == Emission::associated ? Vector3<double>(optics.extinction * optics.color) : optics.color;
  return {q[0], q[1], q[2], optics.extinction};
}

/// The means of q and tau on a stretch where the opacity is linear in x: double-exponential quadrature, which does not
/// mind the logarithm at an opacity of 1. Infinite where the opacity is 1 throughout.
Vec4 mean_opacity_optics(const Bernstein<3>& x, const std::array<double, 2>& opacities, double units_per_length,
                         const Optics& a, const Optics& b, Emission emission) {
  const auto extinction = [&](double u) {
    const double here = x.value(u);
    const double opacity = opacities[0] * (1 - here) + opacities[1] * here;
    const double clear = (1 - opacities[0]) * (1 - here) + (1 - opacities[1]) * here;
    if (!(clear > 0)) return opaque_extinction * units_per_length;
    return units_per_length * (opacity < 0.5 ? -std::log1p(-opacity) : -std::log(clear));
  };
  constexpr double tolerance = 0x1p-40;
  thread_local boost::math::quadrature::tanh_sinh<double> quadrature;
  const auto mean = [](const auto& f) { return quadrature.integrate(f, 0.0, 1.0, tolerance); };
  const double mean_extinction = mean(extinction);
  if (emission == Emission::plain) {
    const Vector3<double> color = a.color + x.integral() * (b.color - a.color);
    return {color[0], color[1], color[2], mean_extinction};
  }
  const double mean_product = mean([&](double u) { return x.value(u) * extinction(u); });
  const Vector3<double> q = (mean_extinction - mean_product) * a.color + mean_product * b.color;
  return {q[0], q[1], q[2], mean_extinction};
}

/// The means of q and tau where the signal stays between two neighbouring points.
Vec4 mean_optics(const Bernstein<3>& signal, const PiecewiseLinear& transfer, Emission emission) {
  const auto& points = transfer.points();
  const auto after = std::upper_bound(points.begin(), points.end(), signal.value(0.5),
                                      [](double s, const TransferPoint& point) { return s < point.s; });
  if (after == points.begin()) return emission_and_extinction(points.front().optics, emission);
  if (after == points.end()) return emission_and_extinction(points.back().optics, emission);

  // x = 0 at the point before, 1 at the one after.
  const TransferPoint& before = *(after - 1);
  Bernstein<3> x = signal;
  for (double& b : x.coefficients) b = (b - before.s) / (after->s - before.s);
  const double x_mean = x.integral();
  const Optics& a = before.optics;
  const Optics& b = after->optics;
  if (transfer.is_linear_in_opacity()) {
    const auto index = static_cast<std::size_t>(after - points.begin());
    return mean_opacity_optics(x, {transfer.opacities()[index - 1], transfer.opacities()[index]},
                               1 / transfer.unit_length(), a, b, emission);
  }
  const double extinction = a.extinction + x_mean * (b.extinction - a.extinction);
  Vector3<double> q = a.color + x_mean * (b.color - a.color);
  if (emission == Emission::associated) {
    // (1 - x)^2, 2 x (1 - x) and x^2 are weights that are never negative: no cancellation in what follows.
    const double x_square = mean_square(x);
    const double mixed = x_mean - x_square;
    q = (1 - x_mean - mixed) * (a.extinction * a.color) + mixed * (a.extinction * b.color + b.extinction * a.color) +
        x_square * (b.extinction * b.color);
  }
  return {q[0], q[1], q[2], extinction};
}

/// Where in (0, 1) the signal crosses points of the transfer function, ascending, between 0 and 1.
std::vector<double> knots(const Bernstein<3>& signal, const PiecewiseLinear& transfer) {
  std::vector<double> result{0};
  const auto [low, high] = signal.range();
  for (const TransferPoint& point : transfer.points()) {
    if (point.s < low || point.s > high) continue;
    Bernstein<3> difference = signal;
    for (double& b : difference.coefficients) b -= point.s;
    const auto crossings = difference.sign_changes();
    result.insert(result.end(), crossings.begin(), crossings.end());
  }
  std::sort(result.begin(), result.end());
  result.push_back(1);
  return result;
}

}  // namespace

Vec4 optics_integral(SlabPieces slab, const PiecewiseLinear& transfer, Emission emission) {
  Vec4 integral = Vec4::Constant(0);
  for (const Piece<3>& piece : slab) {
    const std::vector<double> u = knots(piece.polynomial, transfer);
    for (std::size_t i = 1; i < u.size(); ++i)
      if (u[i - 1] < u[i])
        integral += (u[i] - u[i - 1]) * piece.length *
                    mean_optics(piece.polynomial.restricted(u[i - 1], u[i]), transfer, emission);
  }
  return integral;
}

Vec4 unattenuated_slab(SlabPieces slab, const PiecewiseLinear& transfer, Emission emission) {
  Vec4 result = optics_integral(slab, transfer, emission);
  result[3] = Rules<double>{}.absorption(result[3], false);
  return result;
}

Vec4 iterated_slab(SlabPieces slab, const OpticsLookup<double>& look_up, const Iterations& iterations) {
  double width = 0;
  for (const Piece<3>& piece : slab) width += piece.length;
  Rules<double> rules;
  Vec4 result = Vec4::Constant(0);
  auto piece = slab.begin();
  double piece_begin = 0;
  for (int k = 0; k < iterations.count; ++k) {
    const double x = (k + (iterations.is_left ? 0 : 0.5)) / iterations.count * width;
    while (x >= piece_begin + piece->length && piece + 1 != slab.end()) {
      piece_begin += piece->length;
      ++piece;
    }
    const double u = (x - piece_begin) / piece->length;
    result = rules.over(result,
                        rules.homogeneous_slab(look_up(piece->polynomial.value(u)), width / iterations.count, false));
  }
  return result;
}

}  // namespace raytruth
