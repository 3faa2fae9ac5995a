#include "render/renderer.hpp"

#include "core/error.hpp"
#include "render/image_error.hpp"
#include "signals/random_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace raytruth {
namespace {

Scene scene_of(const std::string& scheme) {
  Grid grid = random_field(20, 1.5, 7);
  grid.spacing = {1, 2, 1.5};
  return {
      .grid = std::move(grid),
      .transfer = PiecewiseLinear({{0.4, {0, {0.2, 0.3, 0.9}}}, {0.6, {0.2, {0.9, 0.6, 0.2}}}, {0.8, {1, {1, 1, 1}}}}),
      .camera = {.eye = {70, 50, 90},
                 .target = {9.5, 19, 14.25},
                 .up = {0, 1, 0},
                 .projection = Perspective{25},
                 .size = {40, 32}},
      .scheme = scheme,
      .step = {}};
}

Image image_of(Scene scene) { return Renderer(std::move(scene)).render().image; }

double largest_difference(const Image& a, const Image& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, (a.pixels[i] - b.pixels[i]).abs().maxCoeff());
  return largest;
}

TEST(Renderer, CellCubicIsTheReferenceToBinary32) {
  const Image truth = image_of(scene_of("reference"));
  // Voxels are rounded to 2^-24 of their range, optical depths up to 1 per voxel and 5 per unit of scalar.
  EXPECT_LT(largest_difference(image_of(scene_of("cell_cubic")), truth), 40 * 5 * 0x1p-24);
}

TEST(Renderer, ReferenceIsThatOfTheWholeRay) {
  Scene scene = scene_of("reference");
  const Rendering all = Renderer(scene).render();
  EXPECT_EQ(all.not_converged, 0);
  // A transfer function that is nowhere clear, but nearly so: nothing is taken out, and little added.
  scene.transfer =
      PiecewiseLinear({{0.4, {1e-18, {0.2, 0.3, 0.9}}}, {0.6, {0.2, {0.9, 0.6, 0.2}}}, {0.8, {1, {1, 1, 1}}}});
  const Rendering whole = Renderer(scene).render();
  for (std::size_t i = 0; i < all.radii.size(); ++i) {
    EXPECT_LT(all.radii[i], 1e-13);
    EXPECT_LE((all.image.pixels[i] - whole.image.pixels[i]).abs().maxCoeff(), all.radii[i] + whole.radii[i] + 1e-15);
  }
}

TEST(Renderer, TablesConvergeToTheirScheme) {
  for (const TableFilter filter : {TableFilter::linear, TableFilter::nearest}) {
    Scene fast = scene_of("order1");
    fast.step = 0.7;
    fast.table = SceneTable{.builder = "exact", .size = 64, .format = table_formats[0], .filter = filter};
    Scene exact = fast;
    exact.table.reset();
    const Image truth = image_of(exact);
    const double error_64 = largest_difference(image_of(fast), truth);
    fast.table->size = 256;
    const double error_256 = largest_difference(image_of(fast), truth);
    // Bilinear tables converge with n^-2 away from kinks, nearest ones with n^-1.
    EXPECT_LT(error_256, error_64 / (filter == TableFilter::linear ? 4 : 2));
    EXPECT_LT(error_256, filter == TableFilter::linear ? 1e-3 : 2e-2);
  }
}

TEST(Renderer, WhatItRefuses) {
  Scene scene = scene_of("order2");
  scene.table = SceneTable{};
  EXPECT_THROW(Renderer{scene}, InputError);
  scene = scene_of("virtual_catmull_rom");
  EXPECT_THROW(Renderer{scene}, InputError);
  scene = scene_of("cell_cubic");
  scene.field = FieldKind::catmull_rom;
  EXPECT_THROW(Renderer{scene}, InputError);
  scene = scene_of("no_scheme");
  EXPECT_THROW(Renderer{scene}, InputError);
  scene = scene_of("reference");
  scene.camera.size = {0, 1};
  EXPECT_THROW(Renderer{scene}, InputError);
}

TEST(Renderer, TellsItsProgress) {
  std::size_t last = 0;
  std::size_t all = 0;
  (void)Renderer(scene_of("cell_cubic")).render([&](std::size_t done, std::size_t of) {
    EXPECT_GE(done, last);
    last = done;
    all = of;
  });
  EXPECT_EQ(all, 3 * 2);  // tiles of 16 x 16 pixels
  EXPECT_LE(last, all);
}

}  // namespace
}  // namespace raytruth
