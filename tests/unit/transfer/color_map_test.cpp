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

TEST(ColorMap, HuesMayTakeTheShorterWay) {
  // Blue, 240 degrees, and red, 0 or 360: magenta is half-way; the longer way goes by green.
  expect_color(color_between(ColorSpace::hsv_wrapped, blue, red, 0.5), {1, 0, 1}, 1e-15);
  expect_color(color_between(ColorSpace::hsv_wrapped, red, blue, 0.5), {1, 0, 1}, 1e-15);
  const Vector3<double> green{0, 1, 0};
  expect_color(color_between(ColorSpace::hsv_wrapped, red, green, 0.5), {1, 1, 0}, 1e-15);
}

TEST(ColorMap, ColorsBeyondTheScreenAreDividedByTheirLargestChannel) {
  // Half-way from yellow to magenta L*a*b* holds (1.06134, 0.65211, 0.64921), by a program of its own.
  expect_color(color_between(ColorSpace::lab, {1, 1, 0}, {1, 0, 1}, 0.5), {1, 0.6144223835, 0.6116879614}, 1e-9);
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

TEST(ColorMap, ColorsOverTheLogarithm) {
  ColorMap map{.is_logarithmic = true, .colors = {{1, blue}, {1000, red}}, .opacities = {{1, 0.2}, {1000, 0.8}}};
  const PiecewiseLinear transfer = transfer_of(map, 1);
  expect_color(transfer.at(10).color, {1 / 3.0, 0, 2 / 3.0}, 1e-5);
  expect_color(transfer.at(100).color, {2 / 3.0, 0, 1 / 3.0}, 1e-5);
  EXPECT_NEAR(transfer.opacity_at(500.5), 0.5, 1e-12);  // opacities are over s itself
  map.colors.front().s = 0;
  EXPECT_THROW(transfer_of(map, 1), InputError);
}

TEST(ColorMap, CurvesBetweenPoints) {
  const auto opacity_at = [](double midpoint, double sharpness, double s) {
    return transfer_of(map_of({{0, 0.2, midpoint, sharpness}, {2, 0.6}}), 1).opacity_at(s);
  };
  // A line broken at the midpoint.
  EXPECT_NEAR(opacity_at(0.25, 0, 0.25), 0.3, 1e-15);
  EXPECT_NEAR(opacity_at(0.25, 0, 0.5), 0.4, 1e-15);
  EXPECT_NEAR(opacity_at(0.25, 0, 1.25), 0.5, 1e-15);
  // A jump at the midpoint.
  EXPECT_NEAR(opacity_at(0.25, 1, 0.499), 0.2, 1e-15);
  EXPECT_NEAR(opacity_at(0.25, 1, 0.5), 0.6, 1e-15);
  // Between the two: half-way at the midpoint, symmetric round 1/2. At a quarter with sharpness 1/2, by hand: the share
  // becomes x = 1/2 (1/2)^6 = 1/128, the cubic 3 x^2 - 2 x^3 + 1/2 (x - 3 x^2 + 2 x^3).
  EXPECT_NEAR(opacity_at(0.5, 0.5, 1), 0.4, 1e-15);
  const double x = 1 / 128.0;
  const double share = x * x * (3 - 2 * x) + 0.5 * (x - 3 * x * x + 2 * x * x * x);
  EXPECT_NEAR(opacity_at(0.5, 0.5, 0.5), 0.2 + 0.4 * share, 1e-15);
  EXPECT_NEAR(opacity_at(0.5, 0.5, 1.5), 0.6 - 0.4 * share, 1e-15);
  EXPECT_THROW(opacity_at(1.5, 0, 0), InputError);
  EXPECT_THROW(opacity_at(0.5, -1, 0), InputError);
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
