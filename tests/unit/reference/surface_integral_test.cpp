#include "raytruth/reference/surface_integral.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// Light of matter and isosurfaces, against closed forms, and against what a ray is without one or the other.
namespace raytruth {
namespace {

const Vector3<double> red{0.9, 0.5, 0.2};
const Vector3<double> blue{0.1, 0.2, 0.3};
const Vector3<double> green{0.2, 0.8, 0.1};

PiecewiseLinear uniform(double extinction) { return PiecewiseLinear({{0, {extinction, red}}}); }

template <int Degree>
Certified light_of(SurfaceIntegral integral, const PreciseChain<Degree>& signal) {
  return integral(signal, surface_hits(signal, integral.scalars()));
}

void expect_near(const Certified& answer, const Vector3<double>& color, double opacity, double most = 1e-13) {
  EXPECT_EQ(answer.status, Status::converged);
  EXPECT_LE(answer.radius, most);
  EXPECT_NEAR(answer.opacity, opacity, answer.radius + 1e-16);
  EXPECT_LE((answer.color - color).abs().maxCoeff(), answer.radius + 1e-16);
}

/// s = t from 0 to 2, surfaces at 1/2 and 3/2 in fog.
TEST(SurfaceIntegral, SurfacesInFogAgainstClosedForms) {
  const auto ramp = precise_piecewise_polynomial({0, 2}, {{0, 1}});
  const std::vector<Isosurface> surfaces{{0.5, 0.25, blue}, {1.5, 0.75, green}};
  for (const double extinction : {0.0, 0.5, 20.0})
    for (const Emission emission : {Emission::associated, Emission::plain}) {
      SCOPED_TRACE(extinction);
      const auto through = [&](double length) { return std::exp(-extinction * length); };
      const auto fog = [&](double length) -> Vector3<double> {
        if (emission == Emission::associated) return red * -std::expm1(-extinction * length);
        return red * (extinction == 0 ? length : -std::expm1(-extinction * length) / extinction);
      };
      Vector3<double> color = fog(0.5);
      double seen = through(0.5);
      color += seen * 0.25 * blue;
      seen *= 0.75;
      color += seen * fog(1);
      seen *= through(1);
      color += seen * 0.75 * green;
      seen *= 0.25;
      color += seen * fog(0.5);
      seen *= through(0.5);
      expect_near(light_of(SurfaceIntegral(uniform(extinction), emission, surfaces), ramp), color, 1 - seen);
    }
}

/// An opaque one hides all that is behind it; a clear one is not seen.
TEST(SurfaceIntegral, OpaqueAndClearSurfaces) {
  const auto ramp = precise_piecewise_polynomial({0, 1}, {{0, 1}});
  const PiecewiseLinear nothing = uniform(0);
  const std::vector<Isosurface> opaque{{0.25, 1, blue}, {0.5, 1, green}};
  expect_near(light_of(SurfaceIntegral(nothing, Emission::associated, opaque), ramp), blue, 1);
  const std::vector<Isosurface> clear{{0.5, 0, blue}};
  expect_near(light_of(SurfaceIntegral(nothing, Emission::associated, clear), ramp), {0, 0, 0}, 0, 1e-14);
  const Certified fog = light_of(SurfaceIntegral(uniform(2), Emission::associated, clear), ramp);
  expect_near(fog, red * -std::expm1(-2), -std::expm1(-2));
}

/// Ten crossings of one surface: each counts, in both directions.
TEST(SurfaceIntegral, EveryCrossingCounts) {
  std::vector<double> breaks{0};
  std::vector<std::vector<double>> powers;
  for (int i = 0; i < 10; ++i) {
    breaks.push_back(i + 1);
    powers.push_back({i % 2 == 0 ? 0.0 : 1.0, i % 2 == 0 ? 1.0 : -1.0});
  }
  const SurfaceIntegral integral(uniform(0), Emission::associated, {{0.5, 0.125, Vector3<double>(1, 1, 1)}});
  const double opacity = 1 - std::pow(0.875, 10);
  expect_near(light_of(integral, precise_piecewise_polynomial(breaks, powers)),
              Vector3<double>(opacity, opacity, opacity), opacity);
}

/// Through a volume: surfaces that are clear cut the ray at their hits and change nothing.
TEST(SurfaceIntegral, CuttingARayChangesNothing) {
  const Grid grid = random_field(10, 0, 8);
  const TrilinearField field(grid);
  const PiecewiseLinear transfer({{0.2, {0, blue}}, {0.5, {3, red}}, {0.5, {1, green}}, {1, {0, blue}}});
  for (int i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    const auto signal = field.trace_precisely({.origin = {0.3, 1 + 0.7 * i, 2}, .direction = {1, 0.3, 0.4}});
    const Certified whole = RayIntegral(transfer, Emission::associated)(signal);
    const Certified cut = light_of(
        SurfaceIntegral(transfer, Emission::associated, {{0.4, 0, red}, {0.5, 0, red}, {0.7, 0, red}}), signal);
    EXPECT_LE(cut.radius, 1e-12);
    EXPECT_NEAR(cut.opacity, whole.opacity, cut.radius + whole.radius);
    EXPECT_LE((cut.color - whole.color).abs().maxCoeff(), cut.radius + whole.radius);
  }
}

/// What is not known of a contact is in the radius.
TEST(SurfaceIntegral, UnresolvedContactsWidenTheRadius) {
  PreciseChain<3> peak = precise_chain(Chain<3>{{{0.0, 1, {{-1, 1 / 3.0, 1 / 3.0, -1}}}}, 1.0});
  peak.pieces[0].error = 1e-20;
  const std::vector<double> scalars{static_cast<double>(peak.pieces[0].polynomial.value(0.5))};
  const SurfaceHits hits = surface_hits(peak, scalars);
  EXPECT_TRUE(hits.hits.empty());
  ASSERT_EQ(hits.unresolved.size(), 1U);
  EXPECT_NEAR(hits.unresolved[0].from, 0.5, 1e-9);
  SurfaceIntegral integral(uniform(1), Emission::associated, {{scalars[0], 0.5, green}});
  const Certified answer = integral(peak, hits);
  EXPECT_EQ(answer.status, Status::not_converged);
  // Two crossings, or none: each is within the radius.
  const double half = std::exp(-0.5);
  const Vector3<double> none = red * -std::expm1(-1);
  const Vector3<double> both = red * (1 - half) + half * (0.75 * green + 0.25 * red * (1 - half));
  EXPECT_LE((answer.color - none).abs().maxCoeff(), answer.radius);
  EXPECT_LE((answer.color - both).abs().maxCoeff(), answer.radius);
}

TEST(SurfaceIntegral, RefusesSurfacesThatAreNone) {
  const auto refuses = [](std::vector<Isosurface> surfaces, const std::string& words) {
    try {
      SurfaceIntegral(uniform(1), Emission::plain, std::move(surfaces));
      ADD_FAILURE() << words;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refuses({{0.5, 0.5, red}, {0.5, 0.5, red}}, "sorted by s, no two at one");
  refuses({{0.5, 1.5, red}}, "opacity 1.5");
  refuses({{0.5, 0.5, {-1, 0, 0}}}, "color");
  refuses({{HUGE_VAL, 0.5, red}}, "s inf");
}

}  // namespace
}  // namespace raytruth
