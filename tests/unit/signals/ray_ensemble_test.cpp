#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

Grid empty_grid(std::array<std::int64_t, 3> size) { return {.size = size, .spacing = {1, 1, 1}, .values = {}}; }

TEST(RayEnsemble, RaysLieInsideAndPointEverywhere) {
  const Grid grid = empty_grid({98, 34, 34});
  std::array<double, 3> mean{};
  constexpr int count = 20000;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Ray ray = random_ray(grid, 8.5, 1, i);
    EXPECT_EQ(ray.length, 8.5);
    const auto direction = unit_direction(ray.direction);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double extent = static_cast<double>(grid.size[axis]) - 1;
      EXPECT_GE(ray.origin[axis], 0);
      EXPECT_LE(ray.origin[axis], extent);
      EXPECT_GE(ray.origin[axis] + 8.5 * direction[axis], -1e-12);
      EXPECT_LE(ray.origin[axis] + 8.5 * direction[axis], extent + 1e-12);
      mean[axis] += direction[axis] / count;
    }
  }
  for (const double component : mean) EXPECT_NEAR(component, 0, 5 * std::sqrt(1.0 / 3 / count));
}

/// Every component of an isotropic direction is uniform in [-1, 1] (Archimedes), and no two of them keep together: the
/// mean of d_i^2 d_j^2 is 1/15, which neither axes nor diagonals have. In a cube no direction fits better than another
/// that its symmetry makes of it; in a large one hardly any other.
TEST(RayEnsemble, RaysPointEverywhereAlike) {
  const Grid grid = empty_grid({1001, 1001, 1001});
  constexpr int count = 20000;
  std::array<std::array<int, 20>, 3> histogram{};
  std::array<double, 3> products{};
  std::array<double, 3> fourth_powers{};
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto d = unit_direction(random_ray(grid, 1, 1, i).direction);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double next = d[(axis + 1) % 3];
      ++histogram[axis][static_cast<std::size_t>(std::min(19.0, std::floor((d[axis] + 1) * 10)))];
      products[axis] += d[axis] * d[axis] * next * next / count;
      fourth_powers[axis] += std::pow(d[axis], 4) / count;
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int in_bin : histogram[axis]) EXPECT_NEAR(in_bin, count / 20, 5 * std::sqrt(count / 20));
    // Deviations of single ones: sqrt(3/315 - 1/225) and sqrt(1/9 - 1/25).
    EXPECT_NEAR(products[axis], 1.0 / 15, 5 * 0.0713 / std::sqrt(count));
    EXPECT_NEAR(fourth_powers[axis], 1.0 / 5, 5 * 0.267 / std::sqrt(count));
  }
}

TEST(RayEnsemble, RefusesRaysThatDoNotFit) {
  EXPECT_THROW(random_ray(empty_grid({5, 5, 5}), 8.5, 1, 0), InputError);
  EXPECT_THROW(random_ray(empty_grid({1, 1, 1}), 0.5, 1, 0), InputError);
  EXPECT_NO_THROW(random_ray(empty_grid({6, 6, 6}), 8, 1, 0));
}

}  // namespace
}  // namespace raytruth
