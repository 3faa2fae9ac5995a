#include "signals/piecewise_polynomial.hpp"

#include "core/error.hpp"

#include <fmt/format.h>
#include <boost/math/special_functions/binomial.hpp>

#include <algorithm>
#include <cmath>

namespace raytruth {

Bernstein<largest_degree> bernstein_from_powers(const std::vector<double>& coefficients, double length) {
  const auto binomial = [](unsigned n, unsigned k) { return boost::math::binomial_coefficient<double>(n, k); };
  std::array<DoubleDouble, largest_degree + 1> sums{};
  DoubleDouble power = 1.0;
  for (unsigned k = 0; k < coefficients.size(); ++k) {
    const DoubleDouble term = power * coefficients[k] / binomial(largest_degree, k);
    for (unsigned i = k; i <= largest_degree; ++i) sums[i] = sums[i] + term * binomial(i, k);
    power = power * length;
  }
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

}  // namespace raytruth
