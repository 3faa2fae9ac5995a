#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/shading/gooch.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/random_slabs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace raytruth {
namespace {

/// A slab without nearly opposite normals, between which curves are singular or nearly so.
LitSlab tame_slab(std::uint64_t index) {
  LitSlab result = random_slab(11, index);
  if (result.slab.cosine() < -0.9) result.slab.back_normal = -result.slab.back_normal;
  return result;
}

Lighting cone_lighting(double shininess) {
  Lighting lighting;
  lighting.specular = 1;
  lighting.shininess = shininess;
  lighting.highlight = find_named(catalogue::highlights(), "cone");
  return lighting;
}

ShadedRadiance shade(std::string_view name, const SlabCosines& cosines, const SlabOptics& optics, Emission emission,
                     const Lighting& lighting) {
  return raytruth::shade(*find_named(catalogue::shadings(), name), cosines, optics, emission, lighting);
}

void expect_near(const ShadedRadiance& found, const ShadedRadiance& truth, double tolerance, const std::string& what) {
  EXPECT_LE((found.ambient - truth.ambient).abs().maxCoeff(), tolerance) << what << ", ambient";
  EXPECT_LE((found.diffuse - truth.diffuse).abs().maxCoeff(), tolerance) << what << ", diffuse";
  EXPECT_LE((found.specular - truth.specular).abs().maxCoeff(), tolerance) << what << ", specular";
  EXPECT_LE(std::abs(found.opacity - truth.opacity), tolerance) << what << ", opacity";
}

/// What integrals in binary64 may be off, on panels of a relative error of some 1e-15 each.
constexpr double allowed = 2e-13;

TEST(SlabShading, EveryCubicIsIntegratedAsTheCertifiedReferenceDoes) {
  for (std::uint64_t index = 0; index < 60; ++index) {
    const auto [slab, lighting] = tame_slab(index);
    const PiecewiseLinear& transfer = transfer_of(index % 4);
    const SlabOptics optics(transfer, slab.front, slab.back, slab.length);
    const SlabCosines c = cosines_of(slab, lighting);
    for (const NormalCurve& curve : catalogue::normal_curves()) {
      if (curve.coefficients == nullptr) continue;
      const auto light = curve.coefficients(c.light_front, c.light_back, c.normals);
      const auto half = curve.coefficients(c.half_front, c.half_back, c.normals);
      // Powers of curves longer than 1 are what they are: relative to them.
      const double largest = std::max(1.0, std::pow(1 / std::sqrt(0.5 + 0.5 * c.normals), lighting.shininess));
      for (const Emission emission : both_conventions) {
        const auto truth = cubic_reference(slab, transfer, emission, lighting, light, half);
        const auto found = shade(curve.name, c, optics, emission, lighting);
        expect_near(found, truth, allowed * std::max(1.0, slab.length) * largest + truth.radius,
                    "slab " + std::to_string(index) + ", " + std::string(curve.name));
      }
    }
  }
}

TEST(SlabShading, NormalisedLinearIsTheReference) {
  for (std::uint64_t index = 0; index < 100; ++index) {
    const auto [slab, lighting] = tame_slab(index);
    const PiecewiseLinear& transfer = transfer_of(index);
    const SlabOptics optics(transfer, slab.front, slab.back, slab.length);
    for (const Emission emission : both_conventions)
      expect_near(shade("normalized_linear", cosines_of(slab, lighting), optics, emission, lighting),
                  slab_reference(slab, transfer, emission, lighting), allowed * std::max(1.0, slab.length),
                  "slab " + std::to_string(index));
  }
}

TEST(SlabShading, DeepSlabsShowTheirFronts) {
  auto [slab, lighting] = tame_slab(3);
  slab.length = 1e7;
  for (const PiecewiseLinear& transfer : {ramp_transfer(3), step_transfer(2)}) {
    const SlabOptics optics(transfer, 0.75, slab.back, slab.length);
    slab.front = 0.75;
    for (const Emission emission : both_conventions)
      expect_near(shade("normalized_linear", cosines_of(slab, lighting), optics, emission, lighting),
                  slab_reference(slab, transfer, emission, lighting), allowed, "deep");
  }
}

TEST(SlabShading, WithoutAngleAllCurvesAreOne) {
  auto [slab, lighting] = tame_slab(1);
  slab.back_normal = slab.front_normal;
  const SlabOptics optics(ramp_transfer(2), slab.front, slab.back, slab.length);
  const SlabCosines cosines = cosines_of(slab, lighting);
  const auto truth = slab_reference(slab, ramp_transfer(2), Emission::associated, lighting);
  for (const NormalCurve& curve : catalogue::normal_curves())
    expect_near(shade(curve.name, cosines, optics, Emission::associated, lighting), truth, allowed,
                std::string(curve.name));
  expect_near(shade("linear_intensity", cosines, optics, Emission::associated, lighting), truth, allowed, "Lum");
}

TEST(SlabShading, LumInterpolatesTheLightOfBothEnds) {
  // Nothing absorbs, colours are 1: the mean of both ends. Unlike the chord inside a lobe (errata, Guetat 12).
  const PiecewiseLinear white({{0, {0, {1, 1, 1}}}});
  const SlabOptics optics(white, 0, 1, 1);
  Lighting lighting;
  lighting.specular = 1;
  lighting.shininess = 2;
  const SlabCosines cosines{0.8, -0.6, 1, 0.5, 0.3};
  const auto found = shade("linear_intensity", cosines, optics, Emission::plain, lighting);
  EXPECT_NEAR(found.diffuse[0], 0.4, 1e-15);
  EXPECT_NEAR(found.specular[0], 0.625, 1e-15);
  const auto chord = shade("linear_gradient", cosines, optics, Emission::plain, lighting);
  EXPECT_NEAR(chord.specular[0], (1 + 0.5 + 0.25) / 3, 1e-15);
  EXPECT_NEAR(chord.diffuse[0], 0.8 * 0.8 / 1.4 / 2, 1e-15);
}

// --- Moments ---

constexpr double tent_precision = 2e-15;

TEST(SlabMoments, OfHomogeneousSlabs) {
  for (const double depth : {0.0, 1e-9, 0.3, 1.999, 2.0, 7.0, 300.0}) {
    const PiecewiseLinear transfer({{0, {depth / 2, {1, 0.5, 0}}}});
    const auto moments = homogeneous_moments(depth);
    const auto found = slab_moments(SlabOptics(transfer, 0.1, 0.9, 2), Emission::associated);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(found.white[k], depth * moments[k], 3e-15) << depth << ", " << k;
      EXPECT_NEAR(found.bare[k], 2 * moments[k], 6e-15) << depth << ", " << k;
      EXPECT_NEAR(found.colored[k][1], 0.5 * depth * moments[k], 3e-15) << depth << ", " << k;
    }
  }
  // In closed form: J_1 = (1 - (1 + y) e^-y) / y^2.
  EXPECT_NEAR(homogeneous_moments(1.5)[1], (1 - 2.5 * std::exp(-1.5)) / 2.25, 1e-16);
  EXPECT_NEAR(homogeneous_moments(40)[1], (1 - 41 * std::exp(-40.0)) / 1600, 1e-18);
}

/// The tent's moment in closed form, 2 ((1 - e^(-y/2)) / y)^2 y of what is white; points of the transfer function,
/// which here say nothing, put panels askew to its top.
TEST(SlabMoments, OfTheTent) {
  for (const double depth : {1e-9, 0.3, 2.0, 7.0, 60.0}) {
    std::vector<TransferPoint> points;
    for (const double s : {0.1, 0.23, 0.61, 0.9}) points.push_back({s, {depth / 2, {1, 0.5, 0}}});
    const double share = -std::expm1(-depth / 2) / depth;
    for (const bool is_forward : {true, false}) {
      const SlabOptics optics(PiecewiseLinear(points), is_forward ? 0.0 : 1.0, is_forward ? 1.0 : 0.0, 2);
      const auto found = slab_moments(optics, Emission::associated);
      EXPECT_NEAR(found.white[4] / (2 * share * share * depth), 1, tent_precision) << depth;
      EXPECT_NEAR(found.bare[4] / (4 * share * share), 1, tent_precision) << depth;
      EXPECT_NEAR(found.colored[4][1] / (share * share * depth), 1, tent_precision) << depth;
    }
  }
}

TEST(SlabMoments, AreCertified) {
  Lighting lighting;
  lighting.negative = Negative::none;
  for (std::uint64_t index = 0; index < 10; ++index) {
    const ShadedSlab slab = tame_slab(index).slab;
    const PiecewiseLinear& transfer = transfer_of(index);
    for (const Emission emission : both_conventions) {
      const auto moments = slab_moments(SlabOptics(transfer, slab.front, slab.back, slab.length), emission);
      for (std::size_t k = 0; k < 4; ++k) {
        Cubic power{};
        power[k] = 1;
        const auto truth = cubic_reference(slab, transfer, emission, lighting, power, power);
        EXPECT_LE((moments.colored[k] - truth.diffuse).abs().maxCoeff(), 3e-14 * std::max(1.0, slab.length));
      }
    }
  }
}

TEST(SlabMoments, MakeTheUnclampedArc) {
  auto [slab, lighting] = tame_slab(5);
  lighting.negative = Negative::none;
  const SlabOptics optics(tent_transfer(9), 0.35, 0.7, 1);
  const SlabCosines c = cosines_of(slab, lighting);
  const NormalCurve& arc = *find_named(catalogue::normal_curves(), "quadratic_arc");
  const auto a = arc.coefficients(c.light_front, c.light_back, c.normals);
  const auto moments = slab_moments(optics, Emission::associated);
  Vector3<double> sum = Vector3<double>::Zero();
  for (std::size_t k = 0; k < 4; ++k) sum += a[k] * moments.colored[k];
  const auto found = shade("quadratic_arc", c, optics, Emission::associated, lighting);
  EXPECT_LE((found.diffuse - lighting.diffuse * sum).abs().maxCoeff(), 1e-14);
}

// --- Guetat's three cases ---

TEST(Fades, NeverGoNegativeAsCorrectedButDoAsPrinted) {
  bool printed_goes_negative = false;
  bool printed_diffuse_goes_negative = false;
  const SlabOptics optics(ramp_transfer(2), 0.2, 0.9, 1);
  for (std::uint64_t index = 0; index < 500; ++index) {
    auto [slab, lighting] = tame_slab(index);
    lighting.negative = Negative::clamp;
    lighting.highlight = find_named(catalogue::highlights(), "cone");
    const SlabCosines cosines = cosines_of(slab, lighting);
    for (const char* const name : {"quadratic_arc_fades", "quadratic_arc_fades_maximum"}) {
      const auto found = shade(name, cosines, optics, Emission::associated, lighting);
      EXPECT_GE(found.diffuse.minCoeff(), 0) << name << " " << index;
      EXPECT_GE(found.specular.minCoeff(), 0) << name << " " << index;
    }
    const auto printed = shade("quadratic_arc_fades_printed", cosines, optics, Emission::associated, lighting);
    printed_diffuse_goes_negative |= printed.diffuse.minCoeff() < -0.01;
    printed_goes_negative |= printed.specular.minCoeff() < -1;
  }
  EXPECT_TRUE(printed_diffuse_goes_negative);
  EXPECT_TRUE(printed_goes_negative);
}

TEST(Fades, ByHand) {
  const PiecewiseLinear white({{0, {0, {1, 1, 1}}}});
  const SlabOptics optics(white, 0, 1, 1);
  const Lighting lighting = cone_lighting(10);
  // Front dark, back lit: a ramp to the light of the back, whose integral is half of it.
  const SlabCosines rising{-0.5, 0.75, 0.5, 0.95, 0.2};
  const auto corrected = shade("quadratic_arc_fades", rising, optics, Emission::plain, lighting);
  EXPECT_NEAR(corrected.diffuse[0], 0.375, 1e-15);
  EXPECT_NEAR(corrected.specular[0], 0.25, 1e-15);
  const auto printed = shade("quadratic_arc_fades_printed", rising, optics, Emission::plain, lighting);
  EXPECT_NEAR(printed.diffuse[0], -0.25, 1e-15);
  EXPECT_NEAR(printed.specular[0], 1 - 10 + 10 * 0.75 / 2, 1e-14);
  // Both dark, but the bisector lies in the highlight: a tent to what the arc's middle has, whose integral is half of
  // it.
  const SlabCosines between{1, 1, 0.7, 0.7, 0};
  const double middle = 0.7 / std::sqrt(0.5);
  EXPECT_NEAR(shade("quadratic_arc_fades", between, optics, Emission::plain, lighting).specular[0], 0, 1e-15);
  EXPECT_NEAR(shade("quadratic_arc_fades_maximum", between, optics, Emission::plain, lighting).specular[0],
              (1 + 10 * (middle - 1)) / 2, 1e-14);
  // Both lit: the arc itself.
  const SlabCosines lit{0.8, 0.7, 0.95, 0.97, 0.9};
  expect_near(shade("quadratic_arc_fades_maximum", lit, optics, Emission::plain, lighting),
              shade("quadratic_arc", lit, optics, Emission::plain, lighting), 1e-14, "lit");
}

TEST(Fades, EmptySpaceShinesOnlyAsPrinted) {
  const SlabOptics empty(ramp_transfer(0), 0, 1, 1);
  const SlabCosines lit{1, 1, 1, 1, 1};
  const Lighting lighting = cone_lighting(10);
  EXPECT_EQ(shade("quadratic_arc_fades", lit, empty, Emission::associated, lighting).specular[0], 0);
  EXPECT_NEAR(shade("quadratic_arc_fades_printed", lit, empty, Emission::associated, lighting).specular[0], 1, 1e-15);
}

TEST(Fades, SayWhatTheyAreMadeFor) {
  const Shading& fades = *find_named(catalogue::shadings(), "quadratic_arc_fades");
  Lighting lighting = cone_lighting(10);
  EXPECT_EQ(fades.refusal(lighting), "");
  lighting.negative = Negative::mirror;
  EXPECT_NE(fades.refusal(lighting), "");
  lighting.negative = Negative::clamp;
  lighting.highlight = find_named(catalogue::highlights(), "lobe");
  EXPECT_NE(fades.refusal(lighting), "");
}

TEST(Fades, FromTablesAsFromIntegrals) {
  using Rule = Rules<double>;
  Rule rules;
  const auto vec4 = [](const auto& a) { return Rule::vec4{a[0], a[1], a[2], a[3]}; };
  const SlabOptics optics(ramp_transfer(2), 0.2, 0.9, 1);
  const auto moments = slab_moments(optics, Emission::associated);
  Rule::vec4 green;
  for (std::size_t k = 0; k < 4; ++k) green[static_cast<Eigen::Index>(k)] = moments.colored[k][1];
  const Rule::vec4 white = vec4(moments.white);
  const Rule::vec4 bare = vec4(moments.bare);
  for (std::uint64_t index = 0; index < 300; ++index) {
    auto [slab, lighting] = tame_slab(index);
    lighting.negative = Negative::clamp;
    lighting.highlight = find_named(catalogue::highlights(), "cone");
    lighting.ambient = 0;
    lighting.diffuse = 1;
    lighting.specular = 1;
    const double n = lighting.shininess;
    const SlabCosines c = cosines_of(slab, lighting);
    const auto light = rules.quadratic_arc(c.light_front, c.light_back, c.normals);
    const auto cone = rules.fades_cone(rules.quadratic_arc(c.half_front, c.half_back, c.normals), n);
    const double front = 1 + n * (c.half_front - 1);
    const double back = 1 + n * (c.half_back - 1);
    const auto is_as = [&](const char* name, double diffuse, double specular) {
      const auto found = shade(name, c, optics, Emission::associated, lighting);
      EXPECT_NEAR(found.diffuse[1], diffuse, 1e-13) << name << " " << index;
      EXPECT_NEAR(found.specular[1], specular, 1e-13 * n) << name << " " << index;
    };
    const double diffuse = rules.fades_integral(green, light, c.light_front, c.light_back);
    is_as("quadratic_arc_fades", diffuse, rules.fades_integral(white, cone, front, back));
    is_as("quadratic_arc_fades_maximum", diffuse, rules.fades_highlight(white, moments.white[4], cone, front, back));
    is_as("quadratic_arc_fades_printed", rules.fades_diffuse_printed(green, light, c.light_front, c.light_back),
          rules.fades_highlight_printed(bare, green, cone, front, back, n, c.light_front, c.light_back));
    const auto lum = shade("linear_intensity", c, optics, Emission::associated, lighting);
    EXPECT_NEAR(
        lum.diffuse[1],
        rules.lighting_interpolated(green, rules.lighting_clamped(c.light_front), rules.lighting_clamped(c.light_back)),
        1e-14);
  }
}

// --- Gooch ---

TEST(GoochTones, TablesMakeTheWhole) {
  const SlabOptics optics(tent_transfer(9), 0.35, 0.7, 1);
  const Gooch gooch;
  const NormalCurve& arc = *find_named(catalogue::normal_curves(), "quadratic_arc");
  const auto a = arc.coefficients(0.9, -0.3, 0.1);
  for (const Emission emission : both_conventions) {
    const auto moments = slab_moments(optics, emission);
    for (Eigen::Index i = 0; i < 3; ++i) {
      double printed = 0;
      for (std::size_t k = 0; k < 4; ++k)
        printed += a[k] / 2 *
                   ((gooch.cool[i] - gooch.warm[i]) * moments.white[k] -
                    (gooch.warm_share - gooch.cool_share) * moments.colored[k][i]);
      const double constant = ((gooch.cool[i] + gooch.warm[i]) * moments.white[0] +
                               (gooch.warm_share + gooch.cool_share) * moments.colored[0][i]) /
                              2;
      EXPECT_NEAR(gooch_color(optics, emission, arc, 0.9, -0.3, 0.1, gooch, true)[i], printed, 1e-14);
      EXPECT_NEAR(gooch_color(optics, emission, arc, 0.9, -0.3, 0.1, gooch)[i], constant + printed, 1e-14);
      Rules<double>::vec4 colored;
      Rules<double>::vec4 white;
      Rules<double>::vec4 curve;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto index = static_cast<Eigen::Index>(k);
        colored[index] = moments.colored[k][i];
        white[index] = moments.white[k];
        curve[index] = a[k];
      }
      Rules<double> rules;
      EXPECT_NEAR(rules.gooch_constant(colored, white, gooch.cool[i], gooch.warm[i], 0.2, 0.6), constant, 1e-15);
      EXPECT_NEAR(rules.gooch_linear(colored, white, curve, gooch.cool[i], gooch.warm[i], 0.2, 0.6), printed, 1e-15);
    }
  }
}

TEST(GoochTones, FacingTheLightIsCoolAndEmptySpaceDark) {
  const PiecewiseLinear black({{0, {1.5, {0, 0, 0}}}});
  const SlabOptics optics(black, 0, 1, 1);
  const NormalCurve& chord = *find_named(catalogue::normal_curves(), "linear_gradient");
  const double opacity = -std::expm1(-1.5);
  const auto facing = gooch_color(optics, Emission::associated, chord, 1, 1, 1, {});
  const auto averted = gooch_color(optics, Emission::associated, chord, -1, -1, 1, {});
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(facing[i], opacity * Gooch{}.cool[i], 1e-15);
    EXPECT_NEAR(averted[i], opacity * Gooch{}.warm[i], 1e-15);
  }
  EXPECT_EQ(gooch_color(SlabOptics(ramp_transfer(0), 0, 1, 1), Emission::associated, chord, 1, 1, 1, {}).maxCoeff(), 0);
}

// --- The dissertation's opacity gradient ---

TEST(OpacityGradient, FollowsTheExtinction) {
  Lighting lighting;
  lighting.specular = 1;
  lighting.shininess = 2;
  const SlabCosines cosines{0.8, 0.8, 0.5, 0.5, 1};
  // d tau / ds = 3 on a ramp; plain colours 1/2 in the middle channel, (1 - e^-D) / D of whose light is seen.
  const PiecewiseLinear flat({{0, {1, {1, 1, 1}}}, {1, {4, {1, 1, 1}}}});
  const SlabOptics rising(flat, 0, 1, 1);
  const SlabOptics falling(flat, 1, 0, 1);
  const double seen_rising = slab_moments(rising, Emission::plain).bare[0];
  const auto up = shade("opacity_gradient", cosines, rising, Emission::plain, lighting);
  EXPECT_NEAR(up.diffuse[0], 3 * 0.8 * seen_rising, 1e-14);
  EXPECT_NEAR(up.specular[0], 9 * 0.25 * seen_rising, 1e-14);
  // The scalar runs the other way, but what counts is the slope over the scalar.
  EXPECT_GT(shade("opacity_gradient", cosines, falling, Emission::plain, lighting).diffuse[0], 0);
  const PiecewiseLinear fading({{0, {4, {1, 1, 1}}}, {1, {1, {1, 1, 1}}}});
  const SlabOptics less(fading, 0, 1, 1);
  const double seen_less = slab_moments(less, Emission::plain).bare[0];
  EXPECT_NEAR(shade("opacity_gradient", cosines, less, Emission::plain, lighting).diffuse[0], -3 * 0.8 * seen_less,
              1e-14);
  EXPECT_EQ(shade("opacity_gradient_normalized", cosines, less, Emission::plain, lighting).diffuse[0], 0);
  // In the quadratic model the normal is linear along the slab; with one normal it is the same light.
  const auto linear = shade("opacity_gradient_linear", cosines, rising, Emission::plain, lighting);
  EXPECT_NEAR(linear.diffuse[0], up.diffuse[0], 1e-14);
  EXPECT_NEAR(linear.specular[0], up.specular[0], 1e-14);
  // Nearly nothing absorbs: the means of 0.2 + 0.6 x and of its square, and of what is left of -0.4 + x above 0.
  const double faint = 1e-9;
  const PiecewiseLinear thin({{0, {faint, {1, 1, 1}}}, {1, {2 * faint, {1, 1, 1}}}});
  const SlabOptics seen(thin, 0, 1, 1);
  const auto through = shade("opacity_gradient_linear", {0.2, 0.8, 0.2, 0.8, 1}, seen, Emission::plain, lighting);
  EXPECT_NEAR(through.diffuse[0] / faint, 0.5, 1e-7);
  EXPECT_NEAR(through.specular[0] / (faint * faint), 0.28, 1e-7);
  const SlabCosines crossing{-0.4, 0.6, -0.4, 0.6, 1};
  EXPECT_NEAR(shade("opacity_gradient_linear_normalized", crossing, seen, Emission::plain, lighting).diffuse[0], 0.18,
              1e-3);
  const SlabOptics falling_seen(PiecewiseLinear({{0, {2 * faint, {1, 1, 1}}}, {1, {faint, {1, 1, 1}}}}), 0, 1, 1);
  EXPECT_NEAR(shade("opacity_gradient_linear_normalized", crossing, falling_seen, Emission::plain, lighting).diffuse[0],
              0.08, 1e-3);
  lighting.shininess = 2.5;
  EXPECT_TRUE(std::isnan(shade("opacity_gradient", cosines, less, Emission::plain, lighting).specular[0]));
}

}  // namespace
}  // namespace raytruth
