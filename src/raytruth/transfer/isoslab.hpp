#pragma once

#include "raytruth/transfer/isosurface.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <cstddef>
#include <vector>

namespace raytruth {

/// What the extinction of an isoslab is.
enum class IsoslabDensity {
  per_length,    ///< one number, as a spike of a transfer function has it (Lum 2004, Engel et al. 2001)
  per_crossing,  ///< one number times abs(ds/dt) (Kraus 2005), so that a passage has one depth
};

/// How isosurfaces become slabs of matter in a table. Around each one lies a box of scalars of this width, with the
/// surface's colour and, D = -ln(1 - opacity),
///
///     extinction (D / width) abs(ds/dt)   (per_crossing)   or   (D / width) slope   (per_length).
///
/// A whole passage has the depth D per crossing, at every width and angle; per length it has D slope / abs(ds/dt).
struct Isoslab {
  std::size_t size = 256;  ///< entries of the table along each axis
  double width = 4;        ///< of a box, in entries
  double slope = 1;        ///< of per_length: the scalar's, per length, at which a passage has the depth D
};

/// The boxes, of this width in scalars, as a transfer function; the extinction of a surface is D `factor` / width.
/// Throws PointError for what `check` refuses, for opacities of 1, which no slab has, and for boxes that touch.
PiecewiseLinear isoslab_transfer(const std::vector<Isosurface>& surfaces, double width, double factor);

}  // namespace raytruth
