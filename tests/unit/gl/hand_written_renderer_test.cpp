#include "raytruth/gl/hand_written_renderer.hpp"

#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/render/pixels.hpp"
#include "raytruth/render/techniques/textured_march.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/transfer/study_transfers.hpp"
#include "unit/gl/on_every_gl.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace raytruth {
namespace {

class HandWrittenRenderer : public OnEveryGl {};

constexpr std::int64_t entries = 65;

/// What the scene's transfer texture says.
PiecewiseLinear tabulated(const PiecewiseLinear& transfer) {
  std::vector<TransferPoint> points;
  for (std::int64_t i = 0; i < entries; ++i) {
    const double s = static_cast<double>(i) / (entries - 1);
    points.push_back({s, transfer.at(s)});
  }
  return PiecewiseLinear(std::move(points));
}

/// Looks at the middle of a grid from a corner's side, in an image that is not square.
Camera camera_around(const Grid& grid, bool is_perspective) {
  Camera camera{.eye = {}, .target = {}, .up = {0.1, 0.2, 1}, .projection = {}, .size = {37, 23}};
  double diagonal = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    camera.target[axis] = grid.spacing[axis] * static_cast<double>(grid.size[axis] - 1) / 2;
    diagonal = std::hypot(diagonal, 2 * camera.target[axis]);
  }
  const std::array<double, 3> away{0.5, -0.7, 0.45};
  for (std::size_t axis = 0; axis < 3; ++axis) camera.eye[axis] = camera.target[axis] + 1.3 * diagonal * away[axis];
  if (is_perspective)
    camera.projection = Perspective{40};
  else
    camera.projection = Orthographic{0.9 * diagonal};
  return camera;
}

TEST_P(HandWrittenRenderer, HomogeneousVolumeIsTheClosedForm) {
  Grid grid{.size = {5, 4, 7}, .spacing = {0.5, 1, 0.75}, .values = {}};
  grid.values.assign(5 * 4 * 7, 0.25);
  for (const bool is_perspective : {false, true}) {
    TexturedScene scene = textured_scene(grid, ramp_transfer(0.8), entries);
    scene.camera = camera_around(grid, is_perspective);
    scene.step = 0.7;
    const Image found = draw_by_hand_written_renderer(*device, scene);
    Image expected(scene.camera.size);
    // Extinction 0.2, colour (1/4, 1/2, 3/4); lengths in halves of a world unit.
    for_each_pixel(grid, scene.camera, [&](const Pixel& pixel) {
      const double opacity = -std::expm1(-0.2 * pixel.signal.length());
      expected.at(pixel.column, pixel.row) = {opacity / 4, opacity / 2, opacity * 3 / 4, opacity};
    });
    double brightest = 0;
    for (std::size_t i = 0; i < found.pixels.size(); ++i) {
      EXPECT_LE((found.pixels[i] - expected.pixels[i]).abs().maxCoeff(), 5e-6) << i;  // lengths of 10 to an ulp
      brightest = std::max(brightest, expected.pixels[i][3]);
    }
    EXPECT_GT(brightest, 0.6);
    EXPECT_EQ(expected.at(0, 0)[3], 0);  // and some of it is background
  }
}

TEST_P(HandWrittenRenderer, IsTheImageOfTheCpu) {
  Grid grid = random_field(12, 1, 7);
  grid.spacing = {1, 1.25, 0.75};
  const PiecewiseLinear transfer = tabulated(gaussian_transfer(0.7));
  const IntegralScheme& midpoints = *find_named(catalogue::integral_schemes(), "riemann_mid");
  for (const bool is_perspective : {false, true}) {
    TexturedScene scene = textured_scene(grid, transfer, entries);
    scene.camera = camera_around(grid, is_perspective);
    scene.step = 0.5;
    const Image found = draw_by_hand_written_renderer(*device, scene);

    const TextureUnit<Binary32> volume(scene.volume);
    const TextureUnit<Binary32> table(scene.transfer);
    Image by_textures(scene.camera.size);
    Image by_scheme(scene.camera.size);
    for_each_pixel(grid, scene.camera, [&](const Pixel& pixel) {
      const auto marched = march_textures(volume, table, pixel.ray, scene.step);
      by_textures.at(pixel.column, pixel.row) = {to_double(marched[0]), to_double(marched[1]), to_double(marched[2]),
                                                 to_double(marched[3])};
      Samples<double> samples;
      sample_constant(pixel.signal, scene.step, samples);
      SchemeIntegral integrate(transfer, Emission::associated);
      const auto outcome = integrate.in_binary32(midpoints, pixel.signal, samples);
      by_scheme.at(pixel.column, pixel.row) << outcome->color, outcome->opacity;
    });
    EXPECT_GT(by_scheme.at(18, 11)[3], 0.3);
    // A scalar is off by some 1e-7, and so is every one of 20 slabs, where the Gaussian's slope is 10 per unit.
    EXPECT_LE(image_error(found, by_textures).maximum, 1e-5);
    EXPECT_LE(image_error(found, by_scheme).maximum, 1e-5);
    EXPECT_LE(image_error(by_textures, by_scheme).maximum, 2e-6);
  }
}

TEST(TexturedScene, RefusesATransferFunctionOfOneEntry) {
  const Grid grid{.size = {1, 1, 1}, .spacing = {1, 1, 1}, .values = {0}};
  EXPECT_THROW(textured_scene(grid, ramp_transfer(1), 1), InputError);
}

INSTANTIATE_TEST_SUITE_P(Gl, HandWrittenRenderer, every_gl_platform, platform_name);

}  // namespace
}  // namespace raytruth
