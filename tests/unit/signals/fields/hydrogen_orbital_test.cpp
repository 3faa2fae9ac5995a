#include "raytruth/signals/fields/hydrogen_orbital.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace raytruth {
namespace {

/// Integral over space of the density times r^power: Simpson's rule on shells, over the polar angle within them.
double moment(const HydrogenOrbital& orbital, int power) {
  constexpr int angles = 100;
  constexpr int shells = 1500;
  const double outermost = 6.0 * static_cast<double>(orbital.n * orbital.n) + 40;
  const auto weight = [](int i, int count) { return (i == 0 || i == count) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0); };
  double sum = 0;
  for (int i = 1; i <= shells; ++i) {
    const double r = outermost * i / shells;
    double of_shell = 0;
    for (int j = 0; j <= angles; ++j) {
      const double cosine = 2.0 * j / angles - 1;
      const double across = r * std::sqrt(std::max(0.0, 1 - cosine * cosine));
      of_shell += weight(j, angles) * hydrogen_density(orbital, across, 0, r * cosine);
    }
    sum += weight(i, shells) * of_shell * std::pow(r, power + 2);
  }
  return 2 * std::numbers::pi * sum * (2.0 / angles / 3) * (outermost / shells / 3);
}

TEST(HydrogenOrbital, HasTheMomentsOfTheTextbook) {
  for (const auto& [n, l, m] :
       {std::array{1, 0, 0}, {2, 0, 0}, {2, 1, -1}, {3, 2, 0}, {4, 2, 1}, {4, 3, 3}, {5, 0, 0}}) {
    const HydrogenOrbital orbital{.n = n, .l = l, .m = m};
    EXPECT_NEAR(moment(orbital, 0), 1, 1e-6) << n << l << m;
    EXPECT_NEAR(moment(orbital, 1), (3 * n * n - l * (l + 1)) / 2.0, 1e-4) << n << l << m;
    EXPECT_NEAR(moment(orbital, -1), 1.0 / (n * n), 1e-5) << n << l << m;
  }
}

TEST(HydrogenOrbital, IsTheClosedFormOfLowOrbitals) {
  const double s1 = hydrogen_density({.n = 1, .l = 0, .m = 0}, 0.3, -0.4, 1.2);
  EXPECT_NEAR(s1, std::exp(-2 * 1.3) / std::numbers::pi, 1e-16);
  EXPECT_NEAR(hydrogen_density({.n = 1, .l = 0, .m = 0}, 0, 0, 0), 1 / std::numbers::pi, 1e-16);
  // 2p along z: z^2 exp(-r) / (32 pi).
  const double p2 = hydrogen_density({.n = 2, .l = 1, .m = 0}, 0.3, -0.4, 1.2);
  EXPECT_NEAR(p2, 1.44 * std::exp(-1.3) / (32 * std::numbers::pi), 1e-16);
  // 3d with m = 2: (x^2 + y^2)^2 exp(-2 r / 3) / (6561 * 4 pi).
  const double d3 = hydrogen_density({.n = 3, .l = 2, .m = 2}, 0.3, -0.4, 1.2);
  EXPECT_NEAR(d3, 0.0625 * std::exp(-2.6 / 3) / (6561 * 4 * std::numbers::pi), 1e-18);
}

TEST(HydrogenOrbital, GridIsItsDensityOverTheLargest) {
  const HydrogenOrbital orbital{.size = 21};
  const Grid grid = make_grid(orbital);
  const auto [low, high] = grid.range();
  EXPECT_EQ(high, 1);
  EXPECT_GE(low, 0);
  // 2 voxels are 4 Bohr radii; a mirror image in every plane through the middle.
  const double scale = grid.at(12, 9, 13) / hydrogen_density(orbital, 4, -2, 6);
  for (std::int64_t i = 0; i < 21; ++i) {
    EXPECT_NEAR(grid.at(i, 7, 4), scale * hydrogen_density(orbital, 2.0 * static_cast<double>(i) - 20, -6, -12), 1e-15);
    EXPECT_NEAR(grid.at(i, 7, 4), grid.at(20 - i, 13, 16), 1e-15);
  }
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(make_grid(orbital).values, grid.values);
}

TEST(HydrogenOrbital, RefusesOptionsOutOfRange) {
  EXPECT_THROW(make_grid(HydrogenOrbital{.size = 1}), FieldOptionError);
  EXPECT_THROW(make_grid(HydrogenOrbital{.n = 2, .l = 2}), FieldOptionError);
  EXPECT_THROW(make_grid(HydrogenOrbital{.n = 3, .l = 1, .m = -2}), FieldOptionError);
  EXPECT_THROW(make_grid(HydrogenOrbital{.extent = 0}), FieldOptionError);
}

}  // namespace
}  // namespace raytruth
