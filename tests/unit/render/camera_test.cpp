#include "raytruth/render/camera.hpp"

#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace raytruth {
namespace {

using Point = std::array<double, 3>;

void expect_near(const Point& found, const Point& expected) {
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], expected[axis], 1e-14) << "axis " << axis;
}

/// Looks along +z from below, y upwards: right is -x.
Camera along_z() {
  return {.eye = {1, 2, -5}, .target = {1, 2, 0}, .up = {0, 1, 0}, .projection = Orthographic{6}, .size = {4, 3}};
}

TEST(Camera, OrthographicPixelCentresRowZeroOnTop) {
  const CameraView view(along_z(), {1, 1, 1});
  // Pixels are 2 wide and high, so the image is 8 x 6.
  expect_near(view(0, 0).ray.origin, {1 + 3, 2 + 2, -5});
  expect_near(view(3, 0).ray.origin, {1 - 3, 2 + 2, -5});
  expect_near(view(0, 2).ray.origin, {1 + 3, 2 - 2, -5});
  expect_near(view(1, 1).ray.origin, {1 + 1, 2, -5});
  for (const auto& [column, row] : {std::pair{0, 0}, {3, 2}}) {
    expect_near(view(column, row).ray.direction, {0, 0, 1});
    EXPECT_EQ(view(column, row).length_unit, 1);
  }
}

TEST(Camera, PerspectiveRaysMeetAtTheEye) {
  Camera camera = along_z();
  camera.projection = Perspective{90};
  const CameraView view(camera, {1, 1, 1});
  // At distance 1 the image is 2 high and 8/3 wide, its pixels 2/3.
  const double norm = std::sqrt(1 + 1 + 4.0 / 9);
  expect_near(view(0, 0).ray.origin, {1, 2, -5});
  expect_near(view(0, 0).ray.direction, {1 / norm, 2.0 / 3 / norm, 1 / norm});
  expect_near(view(3, 2).ray.direction, {-1 / norm, -2.0 / 3 / norm, 1 / norm});
}

TEST(Camera, AngleOfViewIsVertical) {
  Camera camera = along_z();
  camera.projection = Perspective{40};
  camera.size = {7, 1001};
  const Point direction = CameraView(camera, {1, 1, 1})(3, 0).ray.direction;
  EXPECT_NEAR(std::atan2(direction[1], direction[2]) * 180 / std::numbers::pi, 20, 0.02);
  EXPECT_NEAR(direction[0], 0, 1e-15);
}

TEST(Camera, SpacingDividesCoordinatesAndScalesLengths) {
  Camera camera = along_z();
  camera.projection = Perspective{90};
  const Point spacing{0.5, 1, 2};
  const CameraView view(camera, spacing);
  for (const auto& [column, row] : {std::pair{0, 0}, {1, 1}, {3, 2}}) {
    const PixelRay plain = CameraView(camera, {1, 1, 1})(column, row);
    const PixelRay pixel = view(column, row);
    double squares = 0;
    double world_squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_DOUBLE_EQ(pixel.ray.origin[axis] * spacing[axis], plain.ray.origin[axis]);
      // t times length_unit is the distance from the eye in smallest spacings.
      EXPECT_NEAR(pixel.ray.direction[axis] * spacing[axis], plain.ray.direction[axis] * pixel.length_unit * 0.5,
                  1e-15);
      squares += std::pow(pixel.ray.direction[axis], 2);
      world_squares += std::pow(pixel.ray.direction[axis] * spacing[axis], 2);
    }
    EXPECT_NEAR(squares, 1, 1e-15);
    EXPECT_NEAR(pixel.length_unit, std::sqrt(world_squares) / 0.5, 1e-15);
  }
}

TEST(Camera, UpNeedNotBeUprightNorAUnitVector) {
  Camera camera = along_z();
  camera.up = {0, 3, 7};
  expect_near(CameraView(camera, {1, 1, 1})(0, 0).ray.origin, {4, 4, -5});
  camera.up = {1e-200, 1e-200, 0};
  const Point origin = CameraView(camera, {1, 1, 1})(1, 1).ray.origin;
  expect_near(origin, {1 + std::sqrt(0.5), 2 - std::sqrt(0.5), -5});
}

TEST(Camera, RefusesWhatMakesNoImage) {
  const auto refused = [](auto change, const Point& spacing = {1, 1, 1}) {
    Camera camera = along_z();
    change(camera);
    EXPECT_THROW(CameraView(camera, spacing), InputError);
  };
  refused([](Camera& camera) { camera.target = camera.eye; });
  refused([](Camera& camera) { camera.up = {0, 0, -2}; });
  refused([](Camera& camera) { camera.up = {0, 0, 0}; });
  refused([](Camera& camera) { camera.eye[1] = std::numeric_limits<double>::quiet_NaN(); });
  refused([](Camera& camera) { camera.size = {0, 3}; });
  refused([](Camera& camera) { camera.size = {4, largest_image_side + 1}; });
  refused([](Camera& camera) { camera.projection = Orthographic{0}; });
  refused([](Camera& camera) { camera.projection = Perspective{180}; });
  refused([](Camera& camera) { camera.projection = Perspective{-1}; });
  refused([](Camera&) {}, {1, 0, 1});
}

}  // namespace
}  // namespace raytruth
