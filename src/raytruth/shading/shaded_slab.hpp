#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/reference/certified.hpp"

namespace raytruth {

/// A slab between two samples of a ray: the scalar runs linearly from `front` to `back`, the normals are known at both
/// ends only.
struct ShadedSlab {
  double front = 0;
  double back = 0;
  double length = 1;
  Vector3<double> front_normal{0, 0, 1};
  Vector3<double> back_normal{0, 0, 1};

  /// The cosine of the angle between the normals, as they are given.
  [[nodiscard]] double cosine() const { return (front_normal * back_normal).sum(); }
};

/// Light that a shaded slab sends to its front, by the terms of the lighting, and how much light it stops.
struct ShadedRadiance {
  Vector3<double> ambient = Vector3<double>::Constant(0);
  Vector3<double> diffuse = Vector3<double>::Constant(0);
  Vector3<double> specular = Vector3<double>::Constant(0);
  double opacity = 0;

  [[nodiscard]] Vector3<double> color() const { return ambient + diffuse + specular; }
};

/// Light and opacity with a proven bound: every exact channel and the exact opacity lie within `radius` of the values
/// here.
struct CertifiedRadiance : ShadedRadiance {
  double radius = 0;
  Status status = Status::converged;
};

/// How far a unit vector of a slab or of its lighting may be from the length 1; it is used as given.
inline constexpr double largest_norm_error = 1e-6;

/// Normals are refused where their cosine is below this: the direction between antiparallel ones is nobody's guess.
inline constexpr double smallest_normal_cosine = -1 + 1e-12;

/// Throws InputError unless the vector's length is 1, give or take `largest_norm_error`.
void check_unit_vector(const Vector3<double>& vector);

/// Throws InputError unless the normals are unit vectors and not antiparallel, scalars and length finite, length >= 0.
void check(const ShadedSlab& slab);

}  // namespace raytruth
