#include "raytruth/transfer/opacity_convention.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/rules/rules.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace raytruth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(OpacityConvention, ConvertsThereAndBack) {
  for (const double extinction : {0.0, 1e-300, 1e-12, 0.3, 2.0, 30.0})
    EXPECT_NEAR(extinction_of(opacity_of(extinction, 0.5), 0.5), extinction,
                8 * std::exp(extinction / 2) * std::numeric_limits<double>::epsilon() * extinction);
  EXPECT_EQ(opacity_of(1e-20, 1), 1e-20);
  EXPECT_EQ(opacity_of(1e5, 1), 1);
  EXPECT_EQ(extinction_of(1, 1), infinity);
}

TEST(OpacityConvention, CorrectedPartsComposeToTheWhole) {
  Rules<Real50> rules;
  for (const char* text : {"1e-12", "0.001", "0.3", "0.999"})
    for (const int parts : {2, 3, 8}) {
      SCOPED_TRACE(text);
      const Real50 opacity(text);
      const Real50 part = rules.opacity_correction(opacity, 1 / Real50(parts));
      Rules<Real50>::vec4 slab = Rules<Real50>::vec4::Constant(Real50(0));
      Rules<Real50>::vec4 step = slab;
      step[3] = part;
      for (int i = 0; i < parts; ++i) slab = rules.over(slab, step);
      EXPECT_LE(abs(slab[3] - opacity), opacity * Real50("1e-35"));
      EXPECT_NEAR(to_double(part), corrected_opacity(std::stod(text), 1.0 / parts), 4e-16 * to_double(part));
    }
}

TEST(OpacityConvention, RecursionIsTheClosedFormButForRounding) {
  Rules<Real50> rules;
  Real50 opacity("0.7");
  for (int parts = 2; parts <= 64; parts *= 2) {
    opacity = rules.opacity_correction_half(opacity);
    EXPECT_LE(abs(opacity - rules.opacity_correction(Real50("0.7"), 1 / Real50(parts))), Real50("1e-48"));
  }
  // A small opacity loses all its digits in binary32.
  const Binary32 small(2e-8);
  EXPECT_EQ(to_double(Rules<Binary32>{}.opacity_correction_half(small)), 0);
  EXPECT_NEAR(to_double(Rules<Binary32>{}.opacity_correction(small, 0.5)), 1e-8, 1e-14);
}

TEST(OpacityConvention, ClampIsTheFirstOrder) {
  EXPECT_EQ(clamped_opacity(0.25, 2), 0.5);
  EXPECT_EQ(clamped_opacity(0.75, 2), 1);
  for (const double opacity : {1e-3, 1e-5})
    EXPECT_NEAR((clamped_opacity(opacity, 3) - corrected_opacity(opacity, 3)) / (3 * opacity * opacity), 1,
                2 * opacity);
}

TEST(OpacityConvention, CorrectedSlabKeepsItsColourPerOpacity) {
  Rules<double> rules;
  const Rules<double>::vec4 slab = rules.homogeneous_slab({0.2, 0.4, 0.6, 2}, 0.5, false);
  const double part = rules.opacity_correction(slab[3], 0.25);
  const Rules<double>::vec4 corrected = rules.opacity_corrected_slab(slab, part, 0.25);
  const Rules<double>::vec4 expected = rules.homogeneous_slab({0.2, 0.4, 0.6, 2}, 0.125, false);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(corrected[i], expected[i], 1e-16);
  // In empty, glowing space too.
  EXPECT_EQ(rules.opacity_corrected_slab({1, 2, 3, 0}, 0, 0.25)[1], 0.5);
}

TEST(OpacityConvention, RefusesWhatIsNoOpacity) {
  EXPECT_THROW(opacity_of(-1, 1), InputError);
  EXPECT_THROW(opacity_of(infinity, 0), InputError);
  EXPECT_THROW(opacity_of(1, -1), InputError);
  EXPECT_THROW(extinction_of(1.5, 1), InputError);
  EXPECT_THROW(extinction_of(0.5, 0), InputError);
  EXPECT_THROW(corrected_opacity(std::nan(""), 1), InputError);
  EXPECT_THROW(corrected_opacity(0.5, 0), InputError);
  EXPECT_THROW(clamped_opacity(-0.1, 1), InputError);
  EXPECT_THROW(clamped_opacity(0.1, infinity), InputError);
}

}  // namespace
}  // namespace raytruth
