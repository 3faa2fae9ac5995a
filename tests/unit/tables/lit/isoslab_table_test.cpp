#include "raytruth/tables/lit/isoslab_table.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

// Isosurfaces as slabs of matter in tables: their depth by closed forms.
namespace raytruth {
namespace {

const std::vector<Isosurface> two{{.s = 0.25, .opacity = 0.5, .color = {1, 0, 0}},
                                  {.s = 0.75, .opacity = 0.75, .color = {0, 1, 0}}};

Outcome<> light_of(IsoslabDensity density, const Isoslab& isoslab, const std::vector<double>& powers, double length,
                   double step) {
  const auto signal = piecewise_polynomial({0, length}, {powers});
  Samples<double> samples;
  sample_constant(signal, step, samples);
  const IsoslabTable table(two, density, isoslab, {.size = isoslab.size, .low = 0, .high = 1, .length = step});
  return isoslab_light(table, samples);
}

/// Samples on the entries of the table: a passage is as deep as a crossing, at every slope and width.
TEST(IsoslabTable, PassagesPerCrossingHaveTheSurfacesOpacity) {
  for (const double width : {1.0, 3.0, 12.0})
    for (const double length : {0.5, 1.0, 7.0}) {
      const Outcome<> up =
          light_of(IsoslabDensity::per_crossing, {.size = 65, .width = width}, {0, 1 / length}, length, length / 16);
      EXPECT_NEAR(up.opacity, 1 - 0.5 * 0.25, 1e-13);
      EXPECT_NEAR(up.color[0], 0.5, 1e-13);
      EXPECT_NEAR(up.color[1], 0.5 * 0.75, 1e-13);
      const Outcome<> down =
          light_of(IsoslabDensity::per_crossing, {.size = 65, .width = width}, {1, -1 / length}, length, length / 16);
      EXPECT_NEAR(down.color[0], 0.25 * 0.5, 1e-13);
      EXPECT_NEAR(down.color[1], 0.75, 1e-13);
    }
}

/// Per length a passage at the slope abs(s') has opacity 1 - (1 - a)^(slope / abs(s')).
TEST(IsoslabTable, PassagesPerLengthDependOnTheSlope) {
  for (const double length : {0.5, 1.0, 4.0}) {
    const Outcome<> light = light_of(IsoslabDensity::per_length, {.size = 65, .width = 2, .slope = 0.5},
                                     {0, 1 / length}, length, length / 16);
    EXPECT_NEAR(light.opacity, 1 - std::pow(0.5 * 0.25, 0.5 * length), 1e-13);
  }
}

/// A scalar that stays inside a box passes nothing, but has a length.
TEST(IsoslabTable, LevelScalars) {
  const Isoslab isoslab{.size = 65, .width = 4, .slope = 1};
  EXPECT_NEAR(light_of(IsoslabDensity::per_crossing, isoslab, {0.25}, 2, 0.5).opacity, 0, 1e-13);
  // D slope / width per length, over the length 2; a box is 1/16 wide.
  EXPECT_NEAR(light_of(IsoslabDensity::per_length, isoslab, {0.25}, 2, 0.5).opacity, 1 - std::pow(0.5, 2 * 16), 1e-13);
}

/// The last slab is shorter than the table's: per length its opacity is corrected.
TEST(IsoslabTable, ShorterLastSlab) {
  const Isoslab isoslab{.size = 65, .width = 4, .slope = 0.01};
  EXPECT_NEAR(light_of(IsoslabDensity::per_length, isoslab, {0.25}, 1.25, 0.5).opacity, 1 - std::pow(0.5, 1.25 * 0.16),
              1e-13);
}

TEST(IsoslabTable, Refusals) {
  const Isoslab isoslab{.size = 9, .width = 4.5};
  EXPECT_THROW(light_of(IsoslabDensity::per_crossing, isoslab, {0, 1}, 1, 0.5), InputError);  // boxes touch
  EXPECT_THROW(isoslab_transfer({{.s = 0, .opacity = 1, .color = {1, 1, 1}}}, 0.1, 1), InputError);
}

/// Light from a slab's ends goes with matter where it lies: a box in the middle of a slab has the mean of both.
TEST(IsoslabTable, LightBetweenTheEnds) {
  const std::vector<Isosurface> one{{.s = 0.5, .opacity = 1e-6, .color = {1, 1, 1}}};
  const IsoslabTable table(one, IsoslabDensity::per_crossing, {.size = 3, .width = 0.5}, {.size = 3, .length = 1});
  const SlabLight light{.shader = {.at = [](double x, double /*slope*/) { return LitPoint{.diffuse = x * x * x}; }},
                        .model = LightModel({.ambient = 0, .diffuse = 1}, {}, SpecularDensity::white)};
  // The mean of x^3 on [3/8, 5/8], of thin matter.
  const double mean = (std::pow(0.625, 4) - std::pow(0.375, 4)) / 4 / 0.25;
  EXPECT_NEAR(table(0, 1, 1, light)[0], 1e-6 * mean, 1e-11);
}

}  // namespace
}  // namespace raytruth
