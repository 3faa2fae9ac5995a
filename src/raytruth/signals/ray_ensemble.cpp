#include "raytruth/signals/ray_ensemble.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace raytruth {

Ray random_ray(const Grid& grid, double length, std::uint64_t seed, std::uint64_t index) {
  constexpr std::uint32_t most_attempts = 100'000;
  for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
    const auto start = random_numbers(seed, RandomStream::rays, index, 2 * attempt);
    const auto turn = random_numbers(seed, RandomStream::rays, index, 2 * attempt + 1);
    // Archimedes: heights on a sphere are uniform.
    const double height = 2 * turn[0] - 1;
    const double radius = std::sqrt(1 - height * height);
    const double angle = 2 * std::numbers::pi * turn[1];
    Ray ray{.origin = {}, .direction = {radius * std::cos(angle), radius * std::sin(angle), height}, .length = length};
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto extent = static_cast<double>(grid.size[axis] - 1);
      ray.origin[axis] = extent * start[axis];
      const double end = ray.origin[axis] + length * ray.direction[axis];
      inside = inside && end >= 0 && end <= extent;
    }
    if (inside) return ray;
  }
  throw InputError(fmt::format("rays of length {} in a grid of {} x {} x {}; lengths that fit the grid are allowed",
                               length, grid.size[0], grid.size[1], grid.size[2]));
}

}  // namespace raytruth
