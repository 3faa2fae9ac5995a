#pragma once

#include "raytruth/core/named.hpp"

#include <array>

namespace raytruth::catalogue {

/// What the scalar along a ray can be.
inline constexpr std::array signals{
    Named{"piecewise_polynomial", "given coefficients, degree up to 9"},
    Named{"trilinear", "a ray through a voxel grid, trilinear reconstruction: an exact chain of cubics"},
    Named{"tricubic", "a ray through a voxel grid, B-spline (prefiltered or not) or Catmull-Rom: exact, degree 9"},
    Named{"tetrahedra",
          "a ray through a tetrahedral mesh, linear or constant in each cell: an exact walk from face to face"},
    Named{"marschner_lobb", "the Marschner-Lobb signal itself along a ray through [-1, 1]^3"},
    Named{"analytic", "a test signal with a name: sines, Gaussians, a chirp, a step, a kink"},
};

}  // namespace raytruth::catalogue
