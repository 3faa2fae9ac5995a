#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/signals/field_option.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace raytruth {

/// A sum of Gaussians like the potential around a molecule, at size^3 nodes of the unit cube, stretched onto [0, 1] by
/// its extremes there: smooth, of both signs around a level that fills most of the cube, without a symmetry.
struct Molecule {
  static constexpr Named kind{"molecule", "a sum of Gaussians like a molecule's potential, at n^3 nodes, from a seed"};

  std::int64_t size = 64;
  std::int64_t atoms = 24;
  std::uint64_t seed = 1;

  static constexpr auto options() {
    return std::tuple{FieldOption<Molecule, std::int64_t>{"size", &Molecule::size, 2, largest_generated_size},
                      FieldOption<Molecule, std::int64_t>{"atoms", &Molecule::atoms, 1, 4096}};
  }
};

/// amplitude exp(-d^2 / (2 width^2)) at the distance d from its place.
struct GaussianAtom {
  std::array<double, 3> place;
  double width;
  double amplitude;
};

/// Places uniform in the ball of radius 0.3 around the middle of the unit cube, widths uniform in [0.03, 0.08],
/// magnitudes of amplitudes uniform in [0.5, 1], every third one negative.
std::vector<GaussianAtom> atoms_of(const Molecule& molecule);

/// The sum of the atoms at a place.
double potential(std::span<const GaussianAtom> atoms, double x, double y, double z);

/// Throws FieldOptionError.
void check(const Molecule& molecule);
Grid make_grid(const Molecule& molecule);

}  // namespace raytruth
