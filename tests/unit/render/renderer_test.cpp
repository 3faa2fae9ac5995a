#include "raytruth/render/renderer.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/signals/field_kind.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/transfer/emission.hpp"

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

TEST(Renderer, CellCubicIsTheReferenceOfVoxelsInBinary64) {
  const Image truth = image_of(scene_of("reference"));
  // Voxels that binary32 does not hold are taken as they are: what is left is the rounding of some forty cells.
  EXPECT_LT(largest_difference(image_of(scene_of("cell_cubic")), truth), 5e-13);
}

TEST(Renderer, CellCubicIsTheReferenceOfVoxelsInBinary32) {
  const std::array transfers{
      PiecewiseLinear({{0.4, {0, {0.2, 0.3, 0.9}}}, {0.6, {0.2, {0.9, 0.6, 0.2}}}, {0.8, {1, {1, 1, 1}}}}),
      // An isosurface, a jump, matter everywhere, and matter that hides all behind it within a fraction of a voxel.
      PiecewiseLinear({{0.49, {0, {1, 0, 0}}}, {0.5, {50, {1, 1, 0}}}, {0.51, {0, {0, 1, 1}}}}),
      PiecewiseLinear({{0.5, {0, {1, 1, 1}}}, {0.5, {3, {1, 0.5, 0.25}}}, {0.7, {1, {0, 0, 1}}}}),
      PiecewiseLinear({{0, {0.05, {1, 0.5, 0}}}, {1, {0.05, {0, 0.5, 1}}}}),
      PiecewiseLinear({{0.45, {0, {1, 1, 1}}}, {0.7, {5000, {0, 0.5, 1}}}})};
  for (const PiecewiseLinear& transfer : transfers)
    for (const Emission emission : {Emission::associated, Emission::plain}) {
      Scene scene = scene_of("reference");
      scene.transfer = transfer;
      scene.emission = emission;
      for (double& value : scene.grid.values) value = static_cast<float>(value);
      const Image truth = image_of(scene);
      scene.scheme = "cell_cubic";
      // Its rules err by less than 2^-22 of a cell's light, and rays end at a transmittance of 2^-30; a ray is 60 long.
      EXPECT_LT(largest_difference(image_of(scene), truth), 0x1p-22 + 60 * 0x1p-30);
    }
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

TEST(Renderer, TablesOfSecondOrderConvergeToTheirScheme) {
  for (const auto& [step, builder] : {std::pair{std::optional<double>(0.7), "second_order_exact"},
                                      {std::optional<double>(), "second_order_exact"},
                                      {std::optional<double>(0.7), "second_order_iterations"}}) {
    Scene scene = scene_of("order2");
    scene.step = step;
    const Image truth = image_of(scene);
    scene.table = SceneTable{.builder = builder, .iterations = 512, .size = 9, .format = table_formats[0]};
    const double coarse = largest_difference(image_of(scene), truth);
    scene.table->size = 33;
    const double fine = largest_difference(image_of(scene), truth);
    // Trilinear tables converge with n^-2 away from kinks, with n^-1 at them; slabs of other lengths, all of those
    // between cells' borders, have their opacity corrected as if they were homogeneous, which no size mends.
    EXPECT_LT(fine, step ? coarse / 4 : coarse);
    scene.table->filter = TableFilter::nearest;
    EXPECT_GT(largest_difference(image_of(scene), truth), fine);
  }
}

TEST(Renderer, QuadraticTablesConvergeToTheirScheme) {
  for (const char* const scheme : {"order2", "quadratic_gray"}) {
    Scene scene = scene_of(scheme);
    scene.step = 0.7;
    const Image truth = image_of(scene);
    const auto error_of = [&](std::size_t size, std::size_t count, double low) {
      scene.table = SceneTable{.builder = "quadratic_gray",
                               .radius = RadiusAxis{.low = low, .high = 8, .count = count},
                               .size = size,
                               .format = table_formats[0]};
      return largest_difference(image_of(scene), truth);
    };
    const double coarse = error_of(17, 6, 0.0625);
    EXPECT_LT(error_of(65, 24, 0.0625), coarse / 4);
    // Where radii end before the data's steepest slabs these are clamped.
    EXPECT_GT(error_of(65, 24, 4), error_of(65, 24, 0.0625));
    scene.table->filter = TableFilter::nearest;
    EXPECT_GT(largest_difference(image_of(scene), truth), coarse / 4);
  }
  Scene printed = scene_of("quadratic_gray_printed");
  printed.step = 0.7;
  printed.table = SceneTable{.builder = "quadratic_gray_printed", .size = 33};
  EXPECT_THROW(image_of(printed), InputError);
  printed.table->size = 32;
  EXPECT_GT(largest_difference(image_of(printed), image_of(scene_of("order2"))), 1e-3);
}

TEST(Renderer, WhatItRefuses) {
  Scene scene = scene_of("order2");
  scene.table = SceneTable{};
  EXPECT_THROW(Renderer{scene}, InputError);
  scene.table = SceneTable{.builder = "second_order_exact", .size = 257};
  EXPECT_THROW(Renderer{scene}, InputError);
  scene = scene_of("order3");
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
