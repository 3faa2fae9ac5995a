#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/signals/precise_chain.hpp"
#include "raytruth/signals/signal_error_bound.hpp"

#include <vector>

namespace raytruth {

/// A polynomial that is given by its coefficients a_k in ascending powers of x = t - start, on [0, length]:
///     sum_k a_k x^k = sum_i b_i B_i(x / length),  b_i = sum_{k <= i} binomial(i, k) / binomial(n, k) a_k length^k
/// (G. Farin, Curves and Surfaces for CAGD, section 5.8). Sums and products are carried in 106 bits, so each b_i is the
/// binary64 number nearest to its value for the given length, short of cancellation beyond 2^50.
/// `coefficients` has 1 to 10 items. A coefficient b_i that overflows is not finite.
Bernstein<largest_degree> bernstein_from_powers(const std::vector<double>& coefficients, double length);

/// The chain with piece i on [breaks[i], breaks[i+1]] in the powers of t - breaks[i]. Pieces may jump.
/// Throws InputError unless breaks[0] = 0, breaks ascend strictly, there is one list of 1 to 10 coefficients for each
/// piece, everything is finite and nothing overflows.
Chain<largest_degree> piecewise_polynomial(const std::vector<double>& breaks,
                                           const std::vector<std::vector<double>>& coefficients);

/// How far the chain of these breaks and coefficients may be from the polynomials of the binary64 numbers: the largest
/// difference of its Bernstein coefficients and those of the exact lengths, computed in 106 bits. Zero for constants.
/// chain(t) may be read with u = (t - start) / length, and with u from 0 to 1 between start and end_of.
SignalError piecewise_polynomial_error(const std::vector<double>& breaks,
                                       const std::vector<std::vector<double>>& coefficients,
                                       const Chain<largest_degree>& chain);

/// The polynomials of the binary64 numbers in 106 bits, exact ones beside them.
PreciseChain<largest_degree> precise_piecewise_polynomial(const std::vector<double>& breaks,
                                                          const std::vector<std::vector<double>>& coefficients);

}  // namespace raytruth
