#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/schemes/samples.hpp"

#include <array>
#include <cstddef>
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

inline constexpr std::array<std::string_view, 6> surface_method_names{
    "every_crossing", "nearest_normal", "nearest_only", "one_per_step", "peak_finding", "threshold"};

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
