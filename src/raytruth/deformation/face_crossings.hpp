#pragma once

#include "raytruth/deformation/lattice.hpp"
#include "raytruth/deformation/ray_equations.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace raytruth {

/// Where a deformed ray enters or leaves the box of a lattice.
struct FaceCrossing {
  double t = 0;  ///< along the ray in the world
  bool enters = false;
  std::size_t axis = 0;  ///< of the face
  LatticePlace place;
};

/// All crossings of a ray, by t: an entry, then an exit, and so on.
struct FaceCrossings {
  std::vector<FaceCrossing> found;
  /// How long, in the world, parts of the ray may be that touch a face so closely that nobody knows whether they enter.
  double in_doubt = 0;
};

/// The six faces of a lattice's box as the world sees them, in patches of second order in both directions.
class LatticeFaces {
 public:
  explicit LatticeFaces(const Lattice& lattice);

  /// All roots of the ray's two equations on the patches, by subdivision: a part of a patch is left out where the
  /// control points of an equation have one sign; it has one root at most where the derivatives vary by less than half,
  /// in the norm in which the mean one is the identity, and Newton's steps find that or leave the part. What is
  /// smaller than 2^-24 of a patch and still undecided is a contact in doubt.
  [[nodiscard]] FaceCrossings operator()(const RayEquations& equations) const;

 private:
  struct Patch {
    std::size_t axis;
    bool is_last;  ///< at the parameter 1
    std::array<std::int64_t, 3> cell;
    std::array<Eigen::Vector3d, 9> points;  ///< in Bernstein form, in the two axes that follow `axis`
  };

  const Lattice* lattice_;
  std::vector<Patch> patches_;
  double diagonal_ = 0;  ///< of the largest patch
};

}  // namespace raytruth
