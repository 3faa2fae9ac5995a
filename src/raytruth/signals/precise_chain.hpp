#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/chain.hpp"
#include "raytruth/core/double_double.hpp"
#include "raytruth/signals/signal_error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace raytruth {

/// A piece of a signal in 106 bits, in the local coordinate u.
template <int Degree>
struct PrecisePiece {
  double length = 0;  ///< rounded, by no more than a unit in the last place
  Bernstein<Degree, DoubleDouble> polynomial;
  double error = 0;  ///< bounds |s(t) - polynomial(u)|
  /// What the signal is exactly, where it is known: sum_k powers[k] x^k for 0 <= x <= extent. Empty: what is known is
  /// the polynomial above and its error.
  std::vector<double> powers;
  DoubleDouble extent;
};

/// A signal in 106 bits, for where binary64 is too coarse: at jumps of the transfer function, and where the scalar is
/// large against the distances of its points.
template <int Degree>
struct PreciseChain {
  std::vector<PrecisePiece<Degree>> pieces;
  DoubleDouble length;
  double of_length = 0;  ///< error of the length
  double unclaimed = 0;  ///< as in SignalError

  [[nodiscard]] double largest_error() const {
    double largest = 0;
    for (const auto& piece : pieces) largest = std::max(largest, piece.error);
    return largest;
  }
};

/// A chain that stands for itself.
template <int Degree>
PreciseChain<Degree> precise_chain(const Chain<Degree>& chain) {
  PreciseChain<Degree> result{.pieces = {}, .length = chain.end};
  for (const auto& piece : chain.pieces) {
    auto& to = result.pieces.emplace_back();
    to.length = piece.length;
    std::copy(piece.polynomial.coefficients.begin(), piece.polynomial.coefficients.end(),
              to.polynomial.coefficients.begin());
  }
  return result;
}

/// The chain in binary64, and how far it is from the signal.
template <int Degree>
std::pair<Chain<Degree>, SignalError> rounded(const PreciseChain<Degree>& signal) {
  std::pair<Chain<Degree>, SignalError> result;
  auto& [chain, error] = result;
  for (const auto& piece : signal.pieces) {
    double rounding = 0;
    Piece<Degree> to{.start = chain.end, .length = piece.length};
    for (std::size_t k = 0; k <= Degree; ++k) {
      const DoubleDouble& b = piece.polynomial.coefficients[k];
      to.polynomial.coefficients[k] = static_cast<double>(b);
      rounding = std::max(rounding, std::abs(static_cast<double>(b - to.polynomial.coefficients[k])));
    }
    chain.pieces.push_back(to);
    chain.end += piece.length;
    error.of_pieces.push_back((1 + 0x1p-46) * (piece.error + rounding));
  }
  error.of_length = signal.of_length + std::abs(static_cast<double>(signal.length - chain.end));
  error.unclaimed = signal.unclaimed;
  return result;
}

}  // namespace raytruth
