#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/transfer/isoslab.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace raytruth {

/// How a renderer that samples finds isosurfaces.
enum class SurfaceMethod {
  every_crossing,  ///< all values passed between two samples, in order, each at its place on the line between them
  nearest_normal,  ///< the same, all lit by the first one's normal (Meissner et al. 2002, as Lum 2004 tells it)
  nearest_only,    ///< the first value passed between two samples, and no other
  one_per_step,    ///< the state moves by one value at each sample, and the surface is drawn there (VTK)
  peak_finding,    ///< the first value passed, its place by three steps of regula falsi on the signal (Knoll 2009)
  threshold,       ///< every sample nearer to a value than a tolerance
};

/// A way from samples to the light of isosurfaces and of the matter between them: a row of the catalogue.
struct SurfaceScheme {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  SurfaceMethod method{};  ///< says nothing of isoslabs
  /// Whether surfaces are no surfaces but slabs of matter from a table (IsoslabTable), and which; else `SurfaceMarch`
  /// does what the row says.
  std::optional<IsoslabDensity> isoslab = {};
  /// Whether a slab's matter has the optics of its front sample, as `riemann_left`; else the scalar is linear in the
  /// slab, and matter is integrated exactly on both sides of a surface.
  bool samples_matter = false;
  /// Whether a surface's normal is interpolated between those of the samples around it, and normalised; else it is the
  /// gradient's where the surface is met.
  bool interpolates_normals = false;
  std::string_view color = {};   ///< of its line in plots
  std::string_view marker = {};  ///< of its points, as matplotlib names it
};

namespace catalogue {

const std::vector<SurfaceScheme>& surface_schemes();

}  // namespace catalogue

/// How often `peak_finding` reads the signal between two samples.
inline constexpr int regula_falsi_steps = 3;

/// A surface as a method meets it.
struct SampledHit {
  double t = 0;
  std::size_t surface = 0;
  std::size_t interval = 0;  ///< behind which sample it lies
  double normal_t = 0;       ///< where the normal is taken that lights it
};

/// What a method makes of the samples of a signal. Between two of them a surface is crossed where one is below its
/// scalar, and the other at or above it; sampled hits therefore differ from SurfaceHit where the scalar turns between
/// two samples. `tolerance` is that of `threshold`. The scalars ascend.
template <int Degree>
std::vector<SampledHit> sampled_hits(SurfaceMethod method, const Chain<Degree>& signal, const Samples<double>& samples,
                                     const std::vector<double>& scalars, double tolerance = 0);

}  // namespace raytruth
