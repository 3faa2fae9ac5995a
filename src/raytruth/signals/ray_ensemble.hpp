#pragma once

#include "raytruth/signals/ray.hpp"
#include "raytruth/volume/grid.hpp"

#include <cstdint>

namespace raytruth {

/// Ray `index` of an ensemble: direction isotropic, start uniform in [0, n-1]^3, drawn again until the whole ray lies
/// in that box. A function of its arguments alone. Throws InputError where rays of this length hardly fit the grid.
Ray random_ray(const Grid& grid, double length, std::uint64_t seed, std::uint64_t index);

}  // namespace raytruth
