#include "raytruth/rules/rules.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

using Vec4 = Rules<double>::vec4;

TEST(IsosurfaceRules, PassAValueWhereOneSampleIsBelowItAndTheOtherIsNot) {
  Rules<double> rules;
  EXPECT_EQ(rules.isosurface_crossing(0, 1, 0.25), 0.25);
  EXPECT_EQ(rules.isosurface_crossing(1, 0, 0.25), 0.75);
  EXPECT_EQ(rules.isosurface_crossing(0, 0.25, 0.25), 1);  // at it is not below it
  EXPECT_EQ(rules.isosurface_crossing(0.25, 0, 0.25), 0);
  EXPECT_EQ(rules.isosurface_crossing(0.25, 1, 0.25), -1);  // passed in the slab before
  EXPECT_EQ(rules.isosurface_crossing(0.25, 0.25, 0.25), -1);
}

TEST(IsosurfaceRules, FindThePlaceOfASquareByRegulaFalsi) {
  Rules<double> rules;
  Vec4 bracket{0, 1, -0.5, 0.5};  // u^2 - 1/2
  double place = 0;
  for (int step = 0; step < 40; ++step) {
    place = rules.isosurface_regula_falsi(bracket);
    bracket = rules.isosurface_bracket(bracket, place, place * place - 0.5);
    EXPECT_LE(bracket[0], std::sqrt(0.5) + 1e-15);
    EXPECT_GE(bracket[1], std::sqrt(0.5) - 1e-15);
    if (step == 1) {
      EXPECT_DOUBLE_EQ(place, 2.0 / 3);
    }
  }
  EXPECT_NEAR(place, std::sqrt(0.5), 1e-15);
}

TEST(IsosurfaceRules, PutASurfaceOverWhatLiesBehindIt) {
  Rules<double> rules;
  const Vec4 slab = rules.isosurface_slab({0.5, 0.25, 1, 0.5});
  EXPECT_TRUE((slab == Vec4(0.25, 0.125, 0.5, 0.5)).all());
  const Vec4 ray = rules.over({0.125, 0, 0, 0.75}, slab);  // C += T a c, T *= 1 - a with T = 1/4
  EXPECT_TRUE((ray == Vec4(0.1875, 0.03125, 0.125, 0.875)).all());
}

TEST(IsosurfaceRules, NormaliseTheLineBetweenNormals) {
  Rules<double> rules;
  const Vec4 normal = rules.isosurface_normal({1, 0, 0, 0}, {0, 0, 1, 0}, 0.25);
  EXPECT_DOUBLE_EQ(normal[0], 3 / std::sqrt(10));
  EXPECT_EQ(normal[1], 0);
  EXPECT_DOUBLE_EQ(normal[2], 1 / std::sqrt(10));
  EXPECT_EQ(normal[3], 0);
  EXPECT_TRUE((rules.isosurface_normal({0, 1, 0, 0}, {0, -1, 0, 0}, 0.5) == 0).all());
}

}  // namespace
}  // namespace raytruth
