#pragma once

#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/reference/surface_hits.hpp"
#include "raytruth/signals/precise_chain.hpp"
#include "raytruth/transfer/isosurface.hpp"

#include <vector>

namespace raytruth {

/// The volume rendering integral of matter and isosurfaces, certified. A ray is cut at its hits, in 106 bits; between
/// them lies matter, whose slabs are `RayIntegral`'s; and at each
///
///     C += T opacity color,  T *= 1 - opacity.
///
/// The radius has the matter's own, what a hit's place may be off by, and, behind an unresolved contact, all light that
/// there can be.
///
/// Holds buffers: one object per thread.
class SurfaceIntegral {
 public:
  /// Throws InputError as RayIntegral and `check` do.
  SurfaceIntegral(const PiecewiseLinear& transfer, Emission emission, std::vector<Isosurface> isosurfaces);

  /// The scalars of the surfaces.
  [[nodiscard]] const std::vector<double>& scalars() const { return scalars_; }

  /// `hits`: of the signal, by `surface_hits`. The status is as RayIntegral has it.
  template <int Degree>
  Certified operator()(const PreciseChain<Degree>& signal, const SurfaceHits& hits, double tolerance = 1e-13);

 private:
  RayIntegral matter_;
  Emission emission_;
  std::vector<Isosurface> isosurfaces_;
  std::vector<double> scalars_;
  double most_matter_ = 0;   ///< largest colour of the matter
  double most_surface_ = 0;  ///< and of the surfaces
};

/// The signal from one of its places to another, with what those may be off by; null: its beginning, its end.
template <int Degree>
PreciseChain<Degree> between(const PreciseChain<Degree>& signal, const SurfaceHit* from, const SurfaceHit* to);

/// The signal in other units of length: 1 becomes `factor`. Its exact coefficients are left out.
template <int Degree>
void scale_lengths(PreciseChain<Degree>& signal, double factor);

}  // namespace raytruth
