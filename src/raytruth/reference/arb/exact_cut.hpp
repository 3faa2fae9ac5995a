#pragma once

#include "raytruth/signals/precise_chain.hpp"

#include <cstddef>
#include <vector>

namespace raytruth::arb {

/// Part of a piece, between places where its scalar crosses knots.
struct CutPart {
  DoubleDouble begin;  ///< in the piece's unit coordinate
  DoubleDouble end;
  DoubleDouble width;  ///< to 2^-200 of the piece, or its own rounding
  /// The intervals between knots in which the scalar is, a constant on a knot counting as above it. More than one only
  /// where it is nearer to a knot than its error, on the whole part.
  std::size_t first_interval = 0;
  std::size_t last_interval = 0;
};

/// Cuts a piece where its scalar crosses knots, ascending ones, decided without rounding: a polynomial that touches a
/// knot is told from one that crosses it, however flat it is there. Its exact coefficients are rational numbers; the
/// places at which it changes its sign are the roots of the factors of odd multiplicity, isolated by Arb. Where an
/// error is known, that of the signal +- the error.
template <int Degree>
std::vector<CutPart> exact_cut(const PrecisePiece<Degree>& piece, const std::vector<double>& knots);

}  // namespace raytruth::arb
