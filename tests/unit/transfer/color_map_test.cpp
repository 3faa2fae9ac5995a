#include "raytruth/transfer/color_map.hpp"

#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

const Vector3<double> blue{0, 0, 1};
const Vector3<double> red{1, 0, 0};

void expect_color(const Vector3<double>& found, const Vector3<double>& expected, double tolerance) {
  EXPECT_LE((found - expected).abs().maxCoeff(), tolerance) << found.transpose();
}

TEST(ColorMap, MeetsItsColorsInEverySpace) {
  const Vector3<double> a{0.2, 0.7, 0.4};
  const Vector3<double> b{0.9, 0.1, 0.3};
  for (const ColorSpace space : {ColorSpace::rgb, ColorSpace::hsv, ColorSpace::lab, ColorSpace::diverging}) {
    // The matrices between XYZ and sRGB are printed to four decimals.
    expect_color(color_between(space, a, b, 1e-9), a, 1e-3);
    expect_color(color_between(space, a, b, 1 - 1e-9), b, 1e-3);
    expect_color(color_between(space, a, b, 0), a, 0);
    expect_color(color_between(space, a, b, 1), b, 0);
  }
  expect_color(color_between(ColorSpace::step, a, b, 0.1), b, 0);
}

TEST(ColorMap, BetweenColors) {
  expect_color(color_between(ColorSpace::rgb, blue, red, 0.25), {0.25, 0, 0.75}, 0);
  expect_color(color_between(ColorSpace::hsv, blue, red, 0.5), {0, 1, 0}, 1e-15);
  expect_color(color_between(ColorSpace::hsv, blue, red, 0.25), {0, 1, 1}, 1e-15);
  // Greys: L* = 50 has the luminance ((50 + 16) / 116)^3 = 0.18419, sRGB 0.46633.
  expect_color(color_between(ColorSpace::lab, {0, 0, 0}, {1, 1, 1}, 0.5), {0.46633, 0.46633, 0.46633}, 1e-3);
  expect_color(color_between(ColorSpace::diverging, {0, 0, 0}, {1, 1, 1}, 0.5), {0.46633, 0.46633, 0.46633}, 1e-3);
  // Moreland 2009, table 1: the map from cool to warm has (221, 221, 221) in its middle.
  const double middle = 221.0 / 255;
  expect_color(color_between(ColorSpace::diverging, {59 / 255.0, 76 / 255.0, 192 / 255.0},
                             {180 / 255.0, 4 / 255.0, 38 / 255.0}, 0.5),
               {middle, middle, middle}, 2.0 / 255);
}

ColorMap map_of(std::vector<Keyed<double>> opacities) {
  return {.colors = {{0, blue}, {2, red}}, .opacities = std::move(opacities)};
}

TEST(ColorMap, OpacityIsInterpolatedAndThenConverted) {
  const PiecewiseLinear transfer = transfer_of(map_of({{0, 0}, {1, 0.5}, {1, 0.2}, {3, 0.2}}), 0.5);
  EXPECT_DOUBLE_EQ(transfer.at(0.5).extinction, -std::log1p(-0.25) / 0.5);
  EXPECT_DOUBLE_EQ(transfer.at(1).extinction, -std::log1p(-0.2) / 0.5);
  EXPECT_NEAR(transfer.at(std::nextafter(1.0, 0.0)).extinction, -std::log1p(-0.5) / 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(transfer.at(7).extinction, -std::log1p(-0.2) / 0.5);
  expect_color(transfer.at(0.5).color, {0.25, 0, 0.75}, 1e-15);
  expect_color(transfer.at(-1).color, blue, 0);
  EXPECT_EQ(transfer.points().size(), 5U);
}

TEST(ColorMap, IsSampledInOtherSpaces) {
  ColorMap map = map_of({{0, 0.5}});
  map.space = ColorSpace::lab;
  EXPECT_EQ(transfer_of(map, 1).points().size(), 1025);
  map.space = ColorSpace::step;
  const PiecewiseLinear steps = transfer_of(map, 1);
  expect_color(steps.at(0.1).color, red, 0);
  expect_color(steps.at(-0.1).color, blue, 0);
}

TEST(ColorMap, KeepsFullOpacity) { EXPECT_EQ(transfer_of(map_of({{0, 1}}), 1).opacity_at(0), 1); }

TEST(ColorMap, WhatItRefuses) {
  EXPECT_THROW(transfer_of(map_of({}), 1), InputError);
  EXPECT_THROW(transfer_of(map_of({{1, 0}, {0, 0}}), 1), InputError);
  EXPECT_THROW(transfer_of(map_of({{0, 0}, {0, 0}, {0, 0}}), 1), InputError);
  EXPECT_THROW(transfer_of(map_of({{0, 1.1}}), 1), InputError);
  EXPECT_THROW(transfer_of(map_of({{NAN, 0}}), 1), InputError);
  EXPECT_THROW(transfer_of(map_of({{0, NAN}}), 1), InputError);
  EXPECT_THROW(transfer_of(map_of({{0, 0}}), 0), InputError);
  EXPECT_THROW(transfer_of({.opacities = {{0, 0}}}, 1), InputError);
}

}  // namespace
}  // namespace raytruth
