#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/shading/shaded_slab.hpp"

#include <string>
#include <vector>

namespace raytruth {

struct Shading;

/// The frame of the studies of shading: the normals of a slab lie in the x-z plane, their bisector is z, the front one
/// lies on the side of -x. A direction is `in_plane` degrees from the bisector towards the back normal, and `tilt`
/// degrees out of the plane.
Vector3<double> studied_direction(double in_plane, double tilt = 0);

/// The slab's normals for a full angle in degrees.
ShadedSlab studied_slab(double angle);

/// The methods of the catalogue that light a point by its normal alone, without the reference; in its order.
std::vector<const Shading*> studied_shadings();

}  // namespace raytruth
