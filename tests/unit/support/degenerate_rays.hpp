#pragma once

#include "raytruth/signals/ray.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace raytruth::testing_support {

/// Rays through a grid of 5 x 6 x 7 voxels on which a grid walk may stumble.
inline std::vector<Ray> degenerate_rays() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double below_one = std::nextafter(1.0, 0.0);
  return {
      {{-3, 2.25, 3.5}, {3, 0, 0}, infinity},                    // axis-parallel, from outside
      {{-3, 2, 3}, {1, 0, 0}, infinity},                         // along an edge of cells
      {{2, 8, 3.25}, {0, -7, 0}, infinity},                      // along a face, backwards
      {{2.5, 2.5, 2.5}, {0, 0, 1}, infinity},                    // from inside
      {{-1, -1, -1}, {1, 1, 1}, infinity},                       // through corners
      {{5, 5, 5}, {-1, -1, -1}, infinity},                       // through corners, backwards
      {{0, 0, 2.3}, {1, 1, 0}, infinity},                        // through edges
      {{0, 1, 0.5}, {2, 1, 0}, infinity},                        // through every second edge
      {{4, 5, 6}, {-1, 0.3, -0.2}, infinity},                    // from the last voxel
      {{0, 0, 0}, {1, 1e-9, 1e-17}, infinity},                   // nearly parallel
      {{0, 0, 0}, {1, 1e-200, 1e-310}, infinity},                // directions that vanish
      {{2, 2, 2}, {1, -1e-9, 0}, infinity},                      // leaves a face at a grazing angle
      {{-0.5, 2.5, 3.5}, {1, 0.1, 0.1}, infinity},               // starts on the border of the field
      {{4.5, 2.5, 3.5}, {-1, 0.1, 0.1}, infinity},               // and on the opposite one
      {{-0.5, 2.5, 3.5}, {0, 1, 0.2}, infinity},                 // runs along the border of the field
      {{4.5, 5.5, 0}, {0, 0, 1}, infinity},                      // runs along an edge of the field
      {{below_one, below_one, below_one}, {1, 1, 1}, infinity},  // a corner, met within rounding
      {{0.1, 1.1, 2.1}, {1, 1, 1}, infinity},                    // borders met together but for rounding
      {{2.5, 2.5, 2.5}, {1, 2, 3}, 1e-12},                       // shorter than any cell
      {{2.5, 2.5, 2.5}, {1, 2, 3}, 1e-300},                      // next to nothing
      {{-1e6, -1e6, -1e6 + 0.125}, {1, 1, 1}, infinity},         // from afar
      {{-1e12, 2.75, 3.25}, {1, 1e-13, -1e-13}, infinity},       // from very far
  };
}

}  // namespace raytruth::testing_support
