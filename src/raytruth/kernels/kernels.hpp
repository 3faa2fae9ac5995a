#pragma once

#include "raytruth/kernels/linear_piece.hpp"
#include "raytruth/kernels/opacity_piece.hpp"

#include <cstddef>
#include <vector>

namespace raytruth {

/// Eight stretches of polynomial pieces, to be brought into the form of LinearPiece; member by member, for each lane.
template <int Degree>
struct Stretches {
  std::array<Eight, Degree + 1> signal{};  ///< Bernstein coefficients of the whole piece
  Eight signal_error{};                    ///< bound on the signal missed
  Eight begin{};                           ///< in the piece's unit coordinate
  Eight end{};
  Eight origin{};  ///< x = offset + scale (s - origin)
  Eight scale{};
  Eight offset{};
  Eight bottom{};  ///< where x is 0
  Eight top{};     ///< where x is 1
};

/// How far x is above 0 on a stretch, or below 1, by its coefficients; negative: outside. Errors are taken off already.
struct Margins {
  Eight at_begin{};
  Eight at_end{};
  Eight inside{};  ///< the smallest of the coefficients in between
};

template <int Degree>
struct NormalisedStretches {
  std::array<Eight, Degree + 1> x{};
  Eight x_error{};
  Margins from_0;
  Margins from_1;
};

/// The inner loops, in the version for one level of x86-64.
template <int Degree>
struct Kernels {
  /// One piece, its nodes side by side. `nodes` above most_nodes: too deep to be done in one go.
  PieceIntegral<> (*integrate_one)(const LinearPiece<Degree>&, bool associated);

  /// One piece, one node after the other.
  PieceIntegral<> (*integrate_scalar)(const LinearPiece<Degree>&, bool associated);

  /// Eight pieces side by side; each may be too deep by itself.
  PieceIntegral<Eight> (*integrate_eight)(const LinearPiece<Degree, Eight>&, bool associated);

  /// One piece on which the opacity is linear. `nodes` above most_points: to be halved.
  PieceIntegral<> (*integrate_one_opacity)(const OpacityPiece<Degree>&, bool associated);

  /// Eight of them side by side; each may be to be halved by itself.
  PieceIntegral<Eight> (*integrate_eight_opacities)(const OpacityPiece<Degree, Eight>&, bool associated);

  /// Where a polynomial, monotone on [begin, end], takes the values `targets`, which lie between its values there. Good
  /// guesses, to a share of 10^-10 or, `precisely`, to the rounding of the abscissa; not certified: what depends on
  /// them is bounded by what the polynomial is on the stretches between them.
  void (*crossings)(const std::array<double, Degree + 1>& coefficients, double begin, double end, const double* targets,
                    std::size_t count, bool precisely, double* abscissae);

  NormalisedStretches<Degree> (*normalise)(const Stretches<Degree>&);

  /// exp(-depth), relative error exponential_error; depths above 700 count as 700.
  Eight (*transmittances)(const Eight& depths);
};

/// The versions that this processor can run, the best one first. Degree 3 or 9.
template <int Degree>
const std::vector<const Kernels<Degree>*>& kernel_versions();

/// The best version.
template <int Degree>
const Kernels<Degree>& kernels() {
  return *kernel_versions<Degree>().front();
}

}  // namespace raytruth
