#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/deformation/deformed_arc.hpp"
#include "raytruth/deformation/face_crossings.hpp"
#include "raytruth/deformation/lattice.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/volume/grid.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// What a straight ray of the world meets of a deformed object: the scalar by sigma, the length weighted by 1 / J, d
/// sigma = dt / J. With extinction and emission per length of the object's, spread by 1 / J, light along it is that of
/// an ordinary ray of the length of all sigma.
struct DeformedSignal {
  Chain<largest_degree> chain;
  SignalError error;
  /// Relative bound of how far d sigma is from what the chain says, everywhere.
  double rate_error = 0;
  std::size_t cells = 0;     ///< of the volume, that were passed
  std::size_t arcs = 0;      ///< that the curve is made of
  double evaluations = 0;    ///< of F or its derivatives, an arc's counted as its coefficients
  bool is_certified = true;  ///< else a part could not be followed to any error: `error` says infinity
};

/// The object behind a lattice: a volume that is trilinear in its own coordinates, seen deformed.
///
/// A ray in the world is a curve in the object. It is followed from where it enters the lattice's box (LatticeFaces)
/// in arcs (DeformedArc), each in one cell of the lattice and at most so long that its series stop below rounding.
/// Along an arc the borders between voxels are roots of polynomials; in each cell of the volume the scalar, trilinear
/// in three polynomials, is one polynomial of degree 9, with a bound of what that leaves out. A crossing that is found
/// a little too late costs the overshoot times the difference of slopes, at the border of cells of the lattice its
/// square times that of curvatures: both are in the bound. Where one arc ends the next begins in a plane across it.
class DeformedVolume {
 public:
  /// Lengths of the object are voxels times `spacing`. Both must outlive it.
  /// `least_determinant`: of DF, as `proof_of` finds it.
  DeformedVolume(const Grid& voxels, Border border, const std::array<double, 3>& spacing, const Lattice& lattice,
                 double least_determinant);

  /// `ray` is in world coordinates, and may begin inside of the object; its length is not looked at. Throws InputError
  /// for a bad direction.
  void trace(const Ray& ray, DeformedSignal& signal) const;

  [[nodiscard]] const Lattice& lattice() const { return *lattice_; }
  [[nodiscard]] const Grid& grid() const { return *voxels_; }

 private:
  class Tracer;

  const Grid* voxels_;
  Border border_;
  const Lattice* lattice_;
  LatticeFaces faces_;
  Eigen::Matrix3d voxel_by_object_;
  Eigen::Matrix3d voxel_by_local_;  ///< of any cell of the lattice
  double object_volume_by_local_;   ///< signed
  double least_determinant_;
  double curvature_;  ///< bound of what one cell's second derivatives differ from a neighbour's by
};

}  // namespace raytruth
