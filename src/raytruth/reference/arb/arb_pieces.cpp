#include "raytruth/reference/arb/arb_pieces.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/reference/arb/arb_series.hpp"

#include <fmt/format.h>
#include <boost/math/special_functions/binomial.hpp>

#include <array>
#include <cmath>
#include <optional>

namespace raytruth::arb {

namespace {

double binomial(slong n, slong k) {
  return boost::math::binomial_coefficient<double>(static_cast<unsigned>(n), static_cast<unsigned>(k));
}

/// a_k = binomial(n, k) sum_i (-1)^(k - i) binomial(k, i) b_i.
template <std::size_t Size>
Polynomial power_form(const std::array<double, Size>& control) {
  Polynomial result;
  for (std::size_t k = 0; k < Size; ++k) {
    Ball sum;
    for (std::size_t i = 0; i <= k; ++i) {
      const double sign = (k - i) % 2 == 0 ? 1 : -1;
      sum += Ball(sign * binomial(static_cast<slong>(k), static_cast<slong>(i))) * Ball(control[i]);
    }
    result.set(static_cast<slong>(k), Ball(binomial(Size - 1, static_cast<slong>(k))) * sum);
  }
  return result;
}

/// b_i = sum_{k <= i} binomial(i, k) / binomial(n, k) a_k.
std::vector<Ball> bernstein_form(const Polynomial& polynomial) {
  const slong size = std::max<slong>(polynomial.size(), 1);
  std::vector<Ball> scaled(static_cast<std::size_t>(size));
  for (slong k = 0; k < size; ++k)
    scaled[static_cast<std::size_t>(k)] = polynomial.coefficient(k) / Ball(binomial(size - 1, k));
  std::vector<Ball> control(static_cast<std::size_t>(size));
  for (slong i = 0; i < size; ++i)
    for (slong k = 0; k <= i; ++k)
      control[static_cast<std::size_t>(i)] += Ball(binomial(i, k)) * scaled[static_cast<std::size_t>(k)];
  return control;
}

/// Pieces of a formula on [begin, end], halved until the remainders are small; `unit` is the length of 1.
void add_pieces(std::vector<BallPiece>& pieces, const Formula& formula, double begin, double end, const Ball& unit) {
  // Far below what binary64 can tell of signals about 1.
  constexpr double largest_remainder = 0x1p-72;
  constexpr double narrowest = 0x1p-20;
  const bool is_narrow = end - begin < narrowest;
  if (auto model =
          taylor_model(formula, begin, end, is_narrow ? std::nullopt : std::optional<Ball>(largest_remainder))) {
    auto control = bernstein_form(*model);
    pieces.push_back({std::move(*model), std::move(control), unit * (Ball(end) - Ball(begin))});
    return;
  }
  const double middle = begin + (end - begin) / 2;
  add_pieces(pieces, formula, begin, middle, unit);
  add_pieces(pieces, formula, middle, end, unit);
}

/// cos(sqrt(z)) = sum_k (-z)^k / (2k)!, entire. The terms left out are bounded by the series of magnitudes, whose
/// ratio is below 1/2: by twice the first of them.
Series cos_of_root(const Series& z) {
  constexpr slong terms = 40;
  const Ball size = z.polynomial().magnitude();
  Ball bound = 2.0;
  for (slong k = 1; k <= terms; ++k) bound = bound * size / Ball(static_cast<double>(2 * k * (2 * k - 1)));
  if (!(size < Ball(static_cast<double>(terms * terms)))) bound = std::numeric_limits<double>::infinity();
  Series sum(Polynomial(), z.order());
  for (slong k = terms - 1; k >= 0; --k)
    sum = Ball(1.0) - Ball(1.0) / Ball(static_cast<double>((2 * k + 2) * (2 * k + 1))) * (z * sum);
  Polynomial widened_sum;
  for (slong k = 0; k < z.order(); ++k) widened_sum.set(k, widened(sum.polynomial().coefficient(k), bound.upper()));
  return {widened_sum, z.order()};
}

/// What `analytic_signals` computes in binary64, before and behind the signal's break.
std::array<Formula, 2> formulas_of(std::string_view name) {
  const auto sine = [](double period) -> Formula {
    return [period](const Series& t) { return Ball(0.5) + Ball(0.5) * sin(Ball::pi() * 2.0 / period * t); };
  };
  const auto gaussian = [](double divisor) -> Formula {
    return [divisor](const Series& t) {
      const Series distance = Ball(-7.3) + t;
      return exp(Ball(-1.0) / divisor * (distance * distance));
    };
  };
  const auto constant = [](double value) -> Formula {
    return [value](const Series& t) { return Series(Polynomial(value), t.order()); };
  };
  if (name == "sine_slow") return {sine(16)};
  if (name == "sine_near_nyquist") return {sine(2.5)};
  if (name == "gaussian_wide") return {gaussian(8)};
  if (name == "gaussian_narrow") return {gaussian(0.08)};
  if (name == "chirp_past_nyquist")
    return {[](const Series& t) { return Ball(0.5) + Ball(0.5) * sin(Ball::pi() / 16.0 * (t * t)); }};
  if (name == "step_between_samples") return {constant(0), constant(1)};
  if (name == "kink_between_samples")
    return {[](const Series& t) { return Ball(1.0) / 10.0 * (Ball(7.3) - t); },
            [](const Series& t) { return Ball(1.0) / 10.0 * (Ball(-7.3) + t); }};
  throw InputError(fmt::format("found the analytic signal \"{}\", which has no enclosure", name));
}

}  // namespace

template <int Degree>
std::vector<BallPiece> pieces_of(const Chain<Degree>& chain) {
  std::vector<BallPiece> pieces;
  for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
    const auto& [start, length, polynomial] = chain.pieces[i];
    const Ball extent = Ball(chain.end_of(i)) - Ball(start);
    if (!(Ball() < extent)) continue;
    const auto& b = polynomial.coefficients;
    const bool is_whole = arb_equal(extent.get(), Ball(length).get()) != 0;
    pieces.push_back({power_form(b), std::vector<Ball>(b.begin(), b.end()), length, is_whole ? 1.0 : extent / length});
  }
  return pieces;
}

template std::vector<BallPiece> pieces_of(const Chain<3>&);
template std::vector<BallPiece> pieces_of(const Chain<9>&);

std::vector<BallPiece> pieces_of(const MarschnerLobbRay& signal) {
  const Ray& ray = signal.ray;
  unit_direction(ray.direction);  // refuses what has none
  if (!(ray.length >= 0)) throw InputError(fmt::format("length {}; numbers >= 0 are allowed", ray.length));
  Ball square;
  for (const double component : ray.direction) square += Ball(component) * Ball(component);
  const Ball norm = sqrt(square);
  std::array<Ball, 3> direction;
  Ball begin = 0.0;
  std::optional<Ball> end;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    direction[axis] = Ball(ray.direction[axis]) / norm;
    if (ray.direction[axis] == 0) {
      if (!(std::abs(ray.origin[axis]) <= 1)) return {};
      continue;
    }
    const Ball a = (Ball(-1.0) - Ball(ray.origin[axis])) / direction[axis];
    const Ball b = (Ball(1.0) - Ball(ray.origin[axis])) / direction[axis];
    begin = max(begin, min(a, b));
    end = end ? min(*end, max(a, b)) : max(a, b);
  }
  Ball length = std::isinf(ray.length) ? *end - begin : min(*end - begin, ray.length);
  arb_nonnegative_part(length.get(), length.get());
  if (!(Ball() < length.upper())) return {};

  const auto formula = [&](const Series& u) {
    const auto position = [&](std::size_t axis) {
      return Ball(ray.origin[axis]) + begin * direction[axis] + length * direction[axis] * u;
    };
    const Series x = position(0);
    const Series y = position(1);
    const Ball pi = Ball::pi();
    const Ball alpha = 0.25;
    const Series ripple = cos(Ball(12.0) * pi * cos_of_root(pi * pi / 4.0 * (x * x + y * y)));
    return Ball(1.0) / 2.5 * (Ball(1.0) + alpha - sin(pi / 2.0 * position(2)) + alpha * ripple);
  };
  std::vector<BallPiece> pieces;
  add_pieces(pieces, formula, 0, 1, length);
  return pieces;
}

std::vector<BallPiece> pieces_of(const AnalyticSignal& signal) {
  const auto [before, behind] = formulas_of(signal.name);
  std::vector<BallPiece> pieces;
  const double middle = signal.breaks[0];
  if (middle > 0) add_pieces(pieces, before, 0, middle, 1.0);
  add_pieces(pieces, middle > 0 ? behind : before, middle, signal.length, 1.0);
  return pieces;
}

}  // namespace raytruth::arb
