#pragma once

#include "raytruth/deformation/lattice.hpp"

#include <string>

namespace raytruth {

/// Whether a lattice's F is one to one on its box, with the least volume that it presses anything to.
struct LatticeProof {
  double least_determinant = 0;  ///< a lower bound of det DF; positive if there is no refusal
  std::string refusal = {};      ///< what is wrong, with the cells; empty: nothing
};

/// A lattice that is proven one to one.
struct Deformation {
  Lattice lattice;
  double least_determinant = 0;
};

/// det DF is positive everywhere: in a part of a cell with the derivative G_0 in its middle and |G - G_0| <= E, by rows
/// of |G_0^-1| E = n < 1, det G >= det G_0 (1 - n)^3; parts are halved until that is positive, or a middle is not.
///
/// A determinant alone does not keep parts apart which lie far from each other: a bar bent by 400 degrees has a
/// positive determinant. F is one to one on a block of 3^3 cells if sup |A DF - I| < 1 for a matrix A there; any two
/// cells that no block holds have convex hulls (of their Bernstein coefficients) in boxes that do not meet, or these
/// are subdivided. What cannot be proven after six halvings is refused.
LatticeProof proof_of(const Lattice& lattice);

}  // namespace raytruth
