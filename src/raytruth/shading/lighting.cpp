#include "raytruth/shading/lighting.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/shading/shaded_slab.hpp"

#include <fmt/format.h>

#include <initializer_list>

namespace raytruth {

void check_unit_vector(const Vector3<double>& vector) {
  const double norm = std::sqrt(vector.square().sum());
  if (!(std::abs(norm - 1) <= largest_norm_error))
    throw InputError(fmt::format("found a vector of length {}; a length within 1e-6 of 1 is allowed", norm));
}

void check(const Lighting& lighting) {
  check_unit_vector(lighting.light);
  check_unit_vector(lighting.half);
  for (const double coefficient : {lighting.ambient, lighting.diffuse, lighting.specular})
    if (!(coefficient >= 0) || !std::isfinite(coefficient))
      throw InputError(fmt::format("found the coefficient {}; a finite number >= 0 is allowed", coefficient));
  const double n = lighting.shininess;
  if (!(n >= 1 && n <= largest_shininess))
    throw InputError(fmt::format("found shininess {}; a number from 1 to {} is allowed", n, largest_shininess));
  if (lighting.negative == Negative::none && std::floor(n) != n)
    throw InputError(fmt::format("found shininess {}; a whole number is allowed where negative cosines stay", n));
}

void check(const ShadedSlab& slab) {
  check_unit_vector(slab.front_normal);
  check_unit_vector(slab.back_normal);
  if (slab.cosine() < smallest_normal_cosine)
    throw InputError(
        fmt::format("found normals whose cosine is {}; normals that are not antiparallel are allowed", slab.cosine()));
  if (!std::isfinite(slab.front) || !std::isfinite(slab.back))
    throw InputError(fmt::format("found scalars {} and {}; finite numbers are allowed", slab.front, slab.back));
  if (!(slab.length >= 0) || !std::isfinite(slab.length))
    throw InputError(fmt::format("found length {}; a finite number >= 0 is allowed", slab.length));
}

}  // namespace raytruth
