#include "raytruth/render/camera_rounding.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"

#include <gtest/gtest.h>
#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

namespace raytruth {
namespace {

using Vector50 = std::array<Real50, 3>;

Real50 dot(const Vector50& a, const Vector50& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector50 scaled(const Vector50& a, const Real50& by) { return {a[0] * by, a[1] * by, a[2] * by}; }
Vector50 sum(const Vector50& a, const Vector50& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector50 unit(const Vector50& a) { return scaled(a, 1 / sqrt(dot(a, a))); }
Vector50 cross(const Vector50& a, const Vector50& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector50 exactly(const std::array<double, 3>& a) { return {Real50(a[0]), Real50(a[1]), Real50(a[2])}; }

/// A ray in voxels at a unit direction, where it enters the grid, and how far it goes in it.
struct Ray50 {
  Vector50 entry;
  Vector50 direction;
  Real50 length;
};

Ray50 entered(const Vector50& origin, const Vector50& direction, const std::array<std::int64_t, 3>& size,
              Border border) {
  Real50 begin = 0;
  Real50 end = 1e30;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real50 beyond = border == Border::half_voxel ? 0.5 : 0;
    const Real50 low = (-beyond - origin[axis]) / direction[axis];
    const Real50 high = (size[axis] - 1 + beyond - origin[axis]) / direction[axis];
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return {sum(origin, scaled(direction, begin)), direction, std::max(Real50(end - begin), Real50(0))};
}

/// What the camera's numbers mean, in 50 digits: the formulas of CameraView; and the length of a voxel along the ray.
std::pair<Ray50, Real50> meant(const Camera& camera, const std::array<double, 3>& spacing,
                               const std::array<std::int64_t, 3>& size, Border border, std::int64_t column,
                               std::int64_t row) {
  const Vector50 eye = exactly(camera.eye);
  const Vector50 forward = unit(sum(exactly(camera.target), scaled(eye, -1)));
  const Vector50 right = unit(cross(forward, exactly(camera.up)));
  const Vector50 up = cross(right, forward);
  const bool is_perspective = std::holds_alternative<Perspective>(camera.projection);
  const Real50 half = is_perspective ? Real50(tan(Real50(std::get<Perspective>(camera.projection).fov_y) *
                                                  boost::math::constants::pi<Real50>() / 360))
                                     : Real50(std::get<Orthographic>(camera.projection).height) / 2;
  const Real50 x = (Real50(2 * column + 1) / camera.size[0] - 1) * half * camera.size[0] / camera.size[1];
  const Real50 y = (1 - Real50(2 * row + 1) / camera.size[1]) * half;
  const Vector50 aside = sum(scaled(right, x), scaled(up, y));
  const Vector50 world = is_perspective ? sum(forward, aside) : forward;
  Vector50 origin = is_perspective ? eye : sum(eye, aside);
  Vector50 voxels = world;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin[axis] /= spacing[axis];
    voxels[axis] /= spacing[axis];
  }
  const Real50 length =
      sqrt(dot(world, world)) / sqrt(dot(voxels, voxels)) / *std::min_element(spacing.begin(), spacing.end());
  return {entered(origin, unit(voxels), size, border), length};
}

TEST(CameraRounding, CoversWhatBinary64DoesToRays) {
  const std::array<std::int64_t, 3> size{40, 31, 57};
  double largest_share = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const auto random = random_numbers(11, RandomStream::points, i);
    const auto more = random_numbers(11, RandomStream::points, i, 1);
    const double far = std::pow(10, 2 + 4 * random[0]);
    const std::array<double, 3> spacing{0.3 + more[0], 0.3 + more[1], 0.3 + more[2]};
    Camera camera{.eye = {far * (random[1] - 0.5), far * (random[2] - 0.5), far},
                  .target = {20 * spacing[0], 15 * spacing[1], 28 * spacing[2]},
                  .up = {0, 1, 0.1},
                  .size = {7, 5}};
    if (i % 2 == 0)
      camera.projection = Orthographic{30};
    else
      camera.projection = Perspective{2000 / far};
    const CameraView view(camera, spacing);
    const Border border = i % 4 < 2 ? Border::half_voxel : Border::voxel_centres;
    const CameraRounding rounding(camera, spacing, size, border);
    const auto column = static_cast<std::int64_t>(i % 7);
    const auto row = static_cast<std::int64_t>(i % 5);
    const PixelRay pixel = view(column, row);
    const RayDisplacement found = rounding(column, row, pixel);
    ASSERT_FALSE(found.may_differ_in_all);

    const auto [truth, voxel] = meant(camera, spacing, size, border, column, row);
    const Ray50 rounded = entered(exactly(pixel.ray.origin), unit(exactly(pixel.ray.direction)), size, border);
    if (truth.length == 0 || rounded.length == 0) continue;
    // A length at hand is so much along the ray that is meant.
    const Real50 along = pixel.length_unit / voxel;
    EXPECT_LE(abs(truth.length / along - rounded.length), found.of_length);
    for (const Real50& t : {Real50(0), Real50(rounded.length / 3), rounded.length})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Real50 away = abs(truth.entry[axis] + t * along * truth.direction[axis] - rounded.entry[axis] -
                                t * rounded.direction[axis]);
        const double bound = found.at_entry[axis] + static_cast<double>(t) * found.per_voxel[axis];
        EXPECT_LE(away, bound * (1 + 1e-15)) << i << ", axis " << axis;
        if (bound > 0) largest_share = std::max(largest_share, static_cast<double>(away) / bound);
      }
    EXPECT_LT(found.largest(100), 1e-15 * far * 100);
  }
  EXPECT_GT(largest_share, 0.99);  // no bound is wider than it need be
}

TEST(CameraRounding, IsZeroAlongAnAxis) {
  const Camera camera{
      .eye = {3, 2, -20}, .target = {3, 2, 5}, .up = {0, 1, 0}, .projection = Orthographic{2}, .size = {1, 1}};
  const std::array<double, 3> spacing{1, 1, 1};
  const RayDisplacement found = CameraRounding(camera, spacing, {7, 5, 9})(0, 0, CameraView(camera, spacing)(0, 0));
  EXPECT_EQ(found.largest(100), 0);
  EXPECT_EQ(found.of_length, 0);
  EXPECT_FALSE(found.may_differ_in_all);
}

TEST(CameraRounding, TellsWhereARayMayMissTheGrid) {
  // Along the border of the grid, exactly there, and next to parallel to it.
  const std::array<double, 3> spacing{1, 1, 1};
  Camera camera{
      .eye = {-0.5, 2, -20}, .target = {-0.5, 2, 5}, .up = {0, 1, 0}, .projection = Orthographic{2}, .size = {1, 1}};
  const auto displacement = [&] {
    return CameraRounding(camera, spacing, {7, 5, 9})(0, 0, CameraView(camera, spacing)(0, 0));
  };
  EXPECT_FALSE(displacement().may_differ_in_all);
  // Where pixels are no binary64 numbers apart, some rays that are meant pass by while those at hand go through, or the
  // other way round.
  int passing = 0;
  for (const std::int64_t count : {3, 5, 7, 9, 11, 13, 15, 17}) {
    camera.size = {count, count};
    camera.eye[0] = camera.target[0] = -0.5 - (1 - 1.0 / static_cast<double>(count));
    for (int i = 0; i < 4; ++i) {
      const std::int64_t row = count / 2;
      const PixelRay pixel = CameraView(camera, spacing)(0, row);
      const RayDisplacement found = CameraRounding(camera, spacing, {7, 5, 9})(0, row, pixel);
      const Real50 truth = meant(camera, spacing, {7, 5, 9}, Border::half_voxel, 0, row).first.length;
      const Real50 rounded =
          entered(exactly(pixel.ray.origin), unit(exactly(pixel.ray.direction)), {7, 5, 9}, Border::half_voxel).length;
      EXPECT_TRUE(found.may_differ_in_all || found.of_length >= abs(truth - rounded)) << count << ", " << i;
      if (abs(truth - rounded) > 8) ++passing;
      camera.eye[0] = camera.target[0] = std::nextafter(camera.eye[0], -2);
    }
  }
  EXPECT_GT(passing, 0);
}

}  // namespace
}  // namespace raytruth
