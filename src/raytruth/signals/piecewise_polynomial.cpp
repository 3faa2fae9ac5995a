#include "raytruth/signals/piecewise_polynomial.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <boost/math/special_functions/binomial.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace raytruth {

namespace {

double binomial(std::size_t n, std::size_t k) {
  return boost::math::binomial_coefficient<double>(static_cast<unsigned>(n), static_cast<unsigned>(k));
}

/// A number as fraction 2^exponent.
struct Scaled {
  DoubleDouble fraction;
  int exponent = 0;
};

DoubleDouble times_power_of_2(const DoubleDouble& x, int exponent) {
  return {std::ldexp(x.high, exponent), std::ldexp(x.low, exponent)};
}

/// With 1/2 <= |fraction| < 1, so that products of ten of them are far from the ends of binary64's range.
Scaled scaled(const DoubleDouble& x) {
  int exponent = 0;
  static_cast<void>(std::frexp(x.high, &exponent));
  return {times_power_of_2(x, -exponent), exponent};
}

/// See the header for the formula. Each sum is off by less than 2^-96 sum_k |a_k| length^k: no weight is above 1, and a
/// term has passed through at most 22 operations; and by less than 2^-1060 where a term is that small. A power of the
/// length may be far smaller or larger than binary64 holds while its term is not.
Bernstein<largest_degree, DoubleDouble> bernstein_from_powers(const std::vector<double>& coefficients,
                                                              const DoubleDouble& length) {
  Bernstein<largest_degree, DoubleDouble> result;
  const Scaled unit = scaled(length);
  Scaled power{1.0};
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    if (coefficients[k] != 0) {
      const Scaled coefficient = scaled(coefficients[k]);
      const int exponent = power.exponent + coefficient.exponent;
      const DoubleDouble term = power.fraction * coefficient.fraction.high / binomial(largest_degree, k);
      for (std::size_t i = k; i <= largest_degree; ++i)
        result.coefficients[i] += times_power_of_2(term * binomial(i, k), exponent);
    }
    power = {power.fraction * unit.fraction, power.exponent + unit.exponent};
  }
  return result;
}

}  // namespace

Bernstein<largest_degree> bernstein_from_powers(const std::vector<double>& coefficients, double length) {
  const auto sums = bernstein_from_powers(coefficients, DoubleDouble(length)).coefficients;
  Bernstein<largest_degree> result;
  std::transform(sums.begin(), sums.end(), result.coefficients.begin(),
                 [](const DoubleDouble& sum) { return static_cast<double>(sum); });
  return result;
}

Chain<largest_degree> piecewise_polynomial(const std::vector<double>& breaks,
                                           const std::vector<std::vector<double>>& coefficients) {
  const auto is_finite = [](double x) { return std::isfinite(x); };
  if (breaks.size() < 2 || breaks.front() != 0)
    throw InputError(
        "found breaks that do not start at 0, or fewer than two; at least two breaks from 0 on are allowed");
  if (!std::all_of(breaks.begin(), breaks.end(), is_finite) ||
      std::adjacent_find(breaks.begin(), breaks.end(), std::greater_equal<>()) != breaks.end())
    throw InputError("found breaks that do not ascend; finite breaks in strictly ascending order are allowed");
  if (coefficients.size() != breaks.size() - 1)
    throw InputError(fmt::format("found {} lists of coefficients for {} breaks; one list for each piece is allowed",
                                 coefficients.size(), breaks.size()));
  Chain<largest_degree> chain{{}, breaks.back()};
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i].empty() || coefficients[i].size() > largest_degree + 1)
      throw InputError(fmt::format("found {} coefficients in piece {}; 1 to {} are allowed", coefficients[i].size(), i,
                                   largest_degree + 1));
    const double length = breaks[i + 1] - breaks[i];
    const auto polynomial = bernstein_from_powers(coefficients[i], length);
    const auto& b = polynomial.coefficients;
    if (!std::all_of(b.begin(), b.end(), is_finite))
      throw InputError(
          fmt::format("found a polynomial that overflows in piece {}; values that binary64 holds are allowed", i));
    chain.pieces.push_back({breaks[i], length, polynomial});
  }
  return chain;
}

namespace {

constexpr double noise = 0x1p-96;
constexpr double upwards = 1 + 0x1p-46;

/// Whether a polynomial in powers of x, on [0, length], has exactly these values at its two ends.
bool has_ends(const std::vector<double>& coefficients, double length, double begin, double end) {
  using boost::multiprecision::cpp_rational;
  cpp_rational value = 0;
  for (std::size_t k = coefficients.size(); k-- > 0;)
    value = value * cpp_rational(length) + cpp_rational(coefficients[k]);
  return begin == coefficients.front() && value == cpp_rational(end);
}

}  // namespace

SignalError piecewise_polynomial_error(const std::vector<double>& breaks,
                                       const std::vector<std::vector<double>>& coefficients,
                                       const Chain<largest_degree>& chain) {
  SignalError error{.of_pieces = {}, .of_length = std::abs(static_cast<double>(chain.end - breaks.back()))};
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const auto& piece = chain.pieces[i];
    const auto& b = piece.polynomial.coefficients;
    const auto& a = coefficients[i];
    const auto is = [](double x) { return [x](double y) { return x == y; }; };
    if (std::all_of(a.begin() + 1, a.end(), is(0)) && std::all_of(b.begin(), b.end(), is(a[0]))) {
      error.of_pieces.push_back(0);
      error.exact_ends.push_back(true);
      continue;
    }
    const DoubleDouble length = two_sum(breaks[i + 1], -breaks[i]);
    const auto truth = bernstein_from_powers(a, length);
    double difference = 0;
    double step = 0;
    for (std::size_t k = 0; k <= largest_degree; ++k) {
      difference = std::max(difference, std::abs(static_cast<double>(truth.coefficients[k] - b[k])));
      if (k > 0) step = std::max(step, std::abs(b[k] - b[k - 1]));
    }
    double magnitude = 0;
    for (std::size_t k = a.size(); k-- > 0;) magnitude = magnitude * length.high + std::abs(a[k]);
    const double stretch = largest_degree * step * std::abs(static_cast<double>(length - piece.length)) / piece.length;
    error.exact_ends.push_back(static_cast<double>(length) == piece.length && length.low == 0 &&
                               has_ends(a, piece.length, b.front(), b.back()));
    error.of_pieces.push_back(upwards *
                              (difference + stretch + noise * magnitude + std::numeric_limits<double>::min()));
  }
  return error;
}

PreciseChain<largest_degree> precise_piecewise_polynomial(const std::vector<double>& breaks,
                                                          const std::vector<std::vector<double>>& coefficients) {
  PreciseChain<largest_degree> result{.pieces = {}, .length = breaks.back()};
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const DoubleDouble length = two_sum(breaks[i + 1], -breaks[i]);
    double magnitude = 0;
    for (std::size_t k = coefficients[i].size(); k-- > 0;)
      magnitude = magnitude * length.high + std::abs(coefficients[i][k]);
    result.pieces.push_back({.length = length.high,
                             .polynomial = bernstein_from_powers(coefficients[i], length),
                             .error = upwards * (noise * magnitude + std::numeric_limits<double>::min()),
                             .powers = coefficients[i],
                             .extent = length});
  }
  return result;
}

}  // namespace raytruth
