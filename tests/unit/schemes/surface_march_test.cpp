#include "raytruth/schemes/surface_march.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/reference/surface_hits.hpp"
#include "raytruth/reference/surface_integral.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

// The light that methods of renderers make of isosurfaces and of the matter between them.
namespace raytruth {
namespace {

const std::vector<double> breaks{0, 1, 2, 3};
/// s = 4 t up to 1, level, and down again from 2 on.
const std::vector<std::vector<double>> trapezoid{{0, 4}, {4}, {4, -4}};

std::vector<Isosurface> three_surfaces() {
  return {{.s = 1, .opacity = 0.5, .color = {1, 0, 0}},
          {.s = 2, .opacity = 0.25, .color = {0, 1, 0}},
          {.s = 3, .opacity = 0.75, .color = {0, 0, 1}}};
}

PiecewiseLinear fog(double extinction) {
  return PiecewiseLinear({{.s = 0, .optics = {.extinction = extinction, .color = {1, 0.5, 0.25}}}});
}

SurfaceOutcome made_by(const char* name, const PiecewiseLinear& transfer, const std::vector<Isosurface>& surfaces,
                       const std::vector<std::vector<double>>& powers = trapezoid, double tolerance = 0,
                       const SurfaceMarch::ColorOf& color_of = {}) {
  const auto signal =
      piecewise_polynomial(std::vector(breaks.begin(), breaks.begin() + 1 + std::ssize(powers)), powers);
  Samples<double> samples;
  sample_constant(signal, 1.0, samples);
  SurfaceMarch march(transfer, Emission::associated, surfaces);
  return march(*find_named(catalogue::surface_schemes(), name), signal, samples, tolerance, color_of);
}

/// On lines between samples every crossing is met, and all light is the truth's.
TEST(SurfaceMarch, IsTheTruthOnLines) {
  const PiecewiseLinear transfer({{.s = 0, .optics = {.extinction = 0.25, .color = {1, 0.5, 0.25}}},
                                  {.s = 4, .optics = {.extinction = 1.5, .color = {0, 0.5, 1}}}});
  const auto signal = precise_piecewise_polynomial(breaks, trapezoid);
  SurfaceIntegral integral(transfer, Emission::associated, three_surfaces());
  const Certified truth = integral(signal, surface_hits(signal, integral.scalars()));
  for (const char* name : {"every_crossing", "nearest_normal"}) {
    const SurfaceOutcome found = made_by(name, transfer, three_surfaces());
    EXPECT_EQ(found.hits.size(), 6U);
    EXPECT_LE((found.color - truth.color).abs().maxCoeff(), found.radius + truth.radius + 4e-15) << name;
    EXPECT_NEAR(found.opacity, truth.opacity, found.radius + truth.radius + 4e-15) << name;
  }
}

/// By hand, without matter: 1 of opacity 1/2 upwards, then 3 of opacity 3/4 downwards.
TEST(SurfaceMarch, NearestOnlyLosesTheOthers) {
  const SurfaceOutcome found = made_by("nearest_only", fog(0), three_surfaces());
  EXPECT_EQ(found.opacity, 1 - 0.5 * 0.25);
  EXPECT_EQ(found.color[0], 0.5);
  EXPECT_EQ(found.color[1], 0);
  EXPECT_EQ(found.color[2], 0.5 * 0.75);
}

/// The matter of a slab that is sampled lies in front of the surface inside it, and behind one at its front.
TEST(SurfaceMarch, SampledMatterIsWhole) {
  const std::vector<Isosurface> one{{.s = 0.5, .opacity = 1, .color = {0, 0, 1}}};
  const double through = std::exp(-2.0);
  const SurfaceOutcome peak = made_by("peak_finding", fog(2), one, {{0, 1}});
  EXPECT_NEAR(peak.color[0], 1 - through, 1e-15);
  EXPECT_NEAR(peak.color[2], 0.25 * (1 - through) + through, 1e-15);
  const SurfaceOutcome every = made_by("every_crossing", fog(2), one, {{0, 1}});
  EXPECT_NEAR(every.color[0], 1 - std::exp(-1.0), 1e-14);
  const SurfaceOutcome near_front = made_by("threshold", fog(2), one, {{0.5, 1}}, 0.1);
  EXPECT_EQ(near_front.color[0], 0);
  EXPECT_EQ(near_front.color[2], 1);
  // At the last sample all matter is in front.
  const SurfaceOutcome near_end = made_by("threshold", fog(2), one, {{0, 0.5}}, 0.1);
  EXPECT_NEAR(near_end.color[0], 1 - through, 1e-15);
  const SurfaceOutcome behind = made_by("one_per_step", fog(2), one, {{0, 1}});
  EXPECT_NEAR(behind.color[0], 1 - through, 1e-15);
  EXPECT_EQ(behind.opacity, 1);
}

/// A lit surface has the colour that it is asked for.
TEST(SurfaceMarch, AsksForLight) {
  const std::vector<Isosurface> one{{.s = 0.5, .opacity = 0.5, .color = {1, 1, 1}}};
  const auto lit = [](const SampledHit& hit) { return Vector3<double>(hit.normal_t, hit.t, 0); };
  const SurfaceOutcome found = made_by("every_crossing", fog(0), one, {{0, 1}, {1, -1}}, 0, lit);
  EXPECT_NEAR(found.color[0], 0.5 * 0.5 + 0.25 * 1.5, 1e-15);
}

}  // namespace
}  // namespace raytruth
