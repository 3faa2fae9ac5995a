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

TEST(RayEnsemble, RefusesRaysThatDoNotFit) {
  EXPECT_THROW(random_ray(empty_grid({5, 5, 5}), 8.5, 1, 0), InputError);
  EXPECT_THROW(random_ray(empty_grid({1, 1, 1}), 0.5, 1, 0), InputError);
  EXPECT_NO_THROW(random_ray(empty_grid({6, 6, 6}), 8, 1, 0));
}

}  // namespace
}  // namespace raytruth
