#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/vector3.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/schemes/optics_lookup.hpp"
#include "raytruth/schemes/outcome.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/schemes/surface_method.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/isosurface.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <functional>
#include <vector>

namespace raytruth {

/// What a way to find isosurfaces makes of a ray.
struct SurfaceOutcome : Outcome<> {
  std::vector<SampledHit> hits;  ///< in the order in which they are met
};

/// The unit normal that lights a hit, zero where there is none: that of the place `normal_t`, or, of a scheme that
/// interpolates normals, on the line between those of the samples around it, normalised. `normal_at(t)`: unit or zero.
Vector3<double> normal_of(const SurfaceScheme& scheme, const SampledHit& hit, const Samples<double>& samples,
                          const std::function<Vector3<double>(double t)>& normal_at);

/// The light of matter and isosurfaces by the schemes of `catalogue::surface_schemes`, front to back: at each hit
///
///     C += T opacity color,  T *= 1 - opacity,
///
/// and between them matter. Where the scheme samples matter, that of a slab lies in front of a hit inside it, whole:
/// its opacity is not corrected.
///
/// Holds buffers: one object per thread.
class SurfaceMarch {
 public:
  /// What a surface sends out where it is met, before its opacity.
  using ColorOf = std::function<Vector3<double>(const SampledHit&)>;

  /// Throws InputError as RayIntegral and `check` do.
  SurfaceMarch(const PiecewiseLinear& transfer, Emission emission, std::vector<Isosurface> isosurfaces);

  /// The scheme must not be one of isoslabs. `tolerance`: of the scheme `threshold`. `color_of`: as lit; empty: the
  /// surfaces' own colours.
  template <int Degree>
  SurfaceOutcome operator()(const SurfaceScheme& scheme, const Chain<Degree>& signal, const Samples<double>& samples,
                            double tolerance = 0, const ColorOf& color_of = {});

 private:
  /// The matter between two places of the signal that samples make, which the other scalars are of.
  void add_line(double from, double s_from, double to, double s_to);
  /// The matter that has been added since the last surface.
  void close_stretch(SurfaceOutcome& outcome);

  OpticsLookup<double> look_up_;
  RayIntegral matter_;
  std::vector<Isosurface> isosurfaces_;
  std::vector<double> scalars_;
  Chain<3> stretch_;
};

}  // namespace raytruth
