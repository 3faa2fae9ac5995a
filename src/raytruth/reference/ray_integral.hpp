#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/kernels/kernels.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/knot_cut.hpp"
#include "raytruth/reference/linear_interval.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <tuple>
#include <vector>

namespace raytruth {

/// The volume rendering integral of polynomial signals under one transfer function, certified:
///
///     C = integral_0^L q(s(t)) T(t) dt,  A = 1 - T(L),  T(t) = exp(-integral_0^t tau(s)).
///
/// The signal is split where it crosses the transfer function's points. Crossings need not be exact: on each stretch
/// the coefficients of the scalar bound how far, and how long, it is outside the interval whose linear functions are
/// used, and so what that costs. Every stretch is then one certified piece integral; the optical depths add up, and
/// C = sum T_k C_k.
///
/// Holds buffers, so that the second ray allocates nothing: one object per thread.
class RayIntegral {
 public:
  /// Throws InputError as LinearIntervals does.
  RayIntegral(const PiecewiseLinear& transfer, Emission emission);

  /// The integral along a chain of degree 3 or 9 (`largest_degree`). `error` says how far the chain may be from the
  /// signal meant; the radius covers it. A radius above `tolerance` times max(1, largest colour; for plain emission
  /// times the length) makes the status not_converged.
  template <int Degree>
  Certified operator()(const Chain<Degree>& signal, const SignalError& error = {}, double tolerance = 1e-13);

 private:
  template <int Degree>
  struct Buffers {
    std::vector<KnotStretch> stretches;
    std::vector<LinearPiece<Degree, Eight>> pieces;  ///< the first `count` lanes are in use
    std::vector<PieceIntegral<Eight>> integrals;
    std::vector<std::size_t> intervals;
    std::vector<double> depth_errors;  ///< by what the scalar does outside its interval
    std::vector<double> color_errors;
  };

  struct Sum;

  template <int Degree>
  void fit(const Chain<Degree>& signal, const SignalError& error, Buffers<Degree>& buffers) const;
  template <int Degree>
  void accept_or_halve(const Piece<Degree>& piece, double signal_error, const KnotStretch& stretch,
                       const NormalisedStretches<Degree>& normalised, std::size_t lane, int& budget,
                       Buffers<Degree>& buffers) const;
  template <int Degree>
  void integrate_pieces(Buffers<Degree>& buffers, Sum& sum) const;
  [[nodiscard]] Certified finish(const Sum& sum, double length, double hidden, const SignalError& error,
                                 double tolerance) const;

  LinearIntervals intervals_;
  Emission emission_;
  KnotCut cut_;
  std::tuple<Buffers<3>, Buffers<9>> buffers_;
};

}  // namespace raytruth
