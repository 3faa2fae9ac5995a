#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/signals/precise_chain.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <memory>

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
/// Lengths, extinctions and colours whose products leave the range of binary64 are taken in other units, powers of two:
/// the radius then covers what underflows even so. It is 0 only where nothing absorbs or shines.
///
/// A chain in binary64 tells a crossing to some 2^-53 of a piece, which at a jump of the transfer function to the
/// extinction e costs about 10^-15 e, and where a scalar touches it in the order n, 10^(-16/n) e. A chain that stands
/// for itself is therefore cut without rounding where that is too much. Of another one take its `PreciseChain`, which
/// costs nothing at a jump of any height where it has the exact coefficients; else, as for rays through a grid, a
/// scalar of the slope g by u is within its error d of the jump on d/g of a piece, d being about 2^-90 of the largest
/// voxel: no bound that knows no more than d can be better. What touches an opacity of 1 is always looked at in pairs
/// of numbers, which tell it to 2^(-94/n).
///
/// Holds buffers, so that the second ray allocates nothing: one object per thread.
class RayIntegral {
 public:
  /// Throws InputError for points closer together than 2^-500 or farther apart than 2^500, and for extinctions and
  /// colours above 2^500: products of such numbers leave the range of binary64.
  RayIntegral(const PiecewiseLinear& transfer, Emission emission);
  ~RayIntegral();
  RayIntegral(const RayIntegral& other);
  RayIntegral& operator=(const RayIntegral& other);
  RayIntegral(RayIntegral&&) noexcept;
  RayIntegral& operator=(RayIntegral&&) noexcept;

  /// The integral along a chain of degree 3 or 9 (`largest_degree`). `error` says how far the chain may be from the
  /// signal meant; the radius covers it. A radius above `tolerance` times max(1, largest colour; for plain emission
  /// times the length) makes the status not_converged.
  template <int Degree>
  Certified operator()(const Chain<Degree>& signal, const SignalError& error = {}, double tolerance = 1e-13);

  /// The integral of a signal in 106 bits, some 20 times slower: for what has not converged otherwise.
  template <int Degree>
  Certified operator()(const PreciseChain<Degree>& signal, double tolerance = 1e-13);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace raytruth
