#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/signals/fields/generated_fields.hpp"

#include <algorithm>
#include <array>

namespace raytruth::catalogue {

/// What the scalar along a ray can be.
inline constexpr std::array signals{
    Named{"piecewise_polynomial", "given coefficients, degree up to 9"},
    Named{"trilinear", "a ray through a voxel grid, trilinear reconstruction: an exact chain of cubics"},
    Named{"tricubic", "a ray through a voxel grid, B-spline (prefiltered or not) or Catmull-Rom: exact, degree 9"},
    Named{"marschner_lobb", "the Marschner-Lobb signal itself along a ray through [-1, 1]^3"},
    Named{"analytic", "a test signal with a name: sines, Gaussians, a chirp, a step, a kink"},
};

/// Where voxels come from: a generator, or a file.
inline constexpr auto fields = [] {
  std::array<Named, generated_field_kinds.size() + 1> kinds{};
  std::copy(generated_field_kinds.begin(), generated_field_kinds.end(), kinds.begin());
  kinds.back() = {"volume", "a file, NRRD or NIfTI, found by name"};
  return kinds;
}();

}  // namespace raytruth::catalogue
