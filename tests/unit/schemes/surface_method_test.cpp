#include "raytruth/schemes/surface_method.hpp"
#include "raytruth/reference/surface_hits.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

// What methods of renderers make of isosurfaces between samples: where they agree with the crossings, and what each
// loses or adds.
namespace raytruth {
namespace {

using Found = std::vector<std::pair<double, std::size_t>>;

/// t and surface of all hits, at steps of 1.
Found found_by(SurfaceMethod method, const std::vector<double>& breaks, const std::vector<std::vector<double>>& powers,
               const std::vector<double>& scalars, double tolerance = 0) {
  const auto signal = piecewise_polynomial(breaks, powers);
  Samples<double> samples;
  sample_constant(signal, 1.0, samples);
  Found found;
  for (const SampledHit& hit : sampled_hits(method, signal, samples, scalars, tolerance))
    found.emplace_back(hit.t, hit.surface);
  return found;
}

/// s = 4 t up to 1, and down again from 2 on: three surfaces in one slab.
const std::vector<double> breaks{0, 1, 2, 3};
const std::vector<std::vector<double>> trapezoid{{0, 4}, {4}, {4, -4}};
const std::vector<double> three{1, 2, 3};

TEST(SurfaceMethod, SlabsWithSeveralSurfaces) {
  const Found all{{0.25, 0}, {0.5, 1}, {0.75, 2}, {2.25, 2}, {2.5, 1}, {2.75, 0}};
  EXPECT_EQ(found_by(SurfaceMethod::every_crossing, breaks, trapezoid, three), all);
  EXPECT_EQ(found_by(SurfaceMethod::nearest_normal, breaks, trapezoid, three), all);
  EXPECT_EQ(found_by(SurfaceMethod::nearest_only, breaks, trapezoid, three), (Found{{0.25, 0}, {2.25, 2}}));
  const Found peaks = found_by(SurfaceMethod::peak_finding, breaks, trapezoid, three);
  ASSERT_EQ(peaks.size(), 2U);
  EXPECT_NEAR(peaks[0].first, 0.25, 1e-15);
  EXPECT_NEAR(peaks[1].first, 2.25, 1e-15);
  // It is one value behind at t = 1, two at the end: it never meets the third.
  EXPECT_EQ(found_by(SurfaceMethod::one_per_step, breaks, trapezoid, three), (Found{{1, 0}, {2, 1}, {3, 1}}));
  EXPECT_EQ(found_by(SurfaceMethod::threshold, breaks, trapezoid, {0, 4}, 0.5),
            (Found{{0, 0}, {1, 1}, {2, 1}, {3, 0}}));
}

/// On linear pieces whose ends are samples the line is the signal, and every crossing is found where it is.
TEST(SurfaceMethod, EveryCrossingIsExactOnLines) {
  const auto signal = precise_piecewise_polynomial(breaks, trapezoid);
  const auto truth = surface_hits(signal, three).hits;
  const Found found = found_by(SurfaceMethod::every_crossing, breaks, trapezoid, three);
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(found[i].second, truth[i].surface);
    EXPECT_NEAR(found[i].first, static_cast<double>(truth[i].t), truth[i].error + 1e-15);
  }
}

/// Where the scalar turns between two samples all of them lose both crossings.
TEST(SurfaceMethod, TurnsBetweenSamplesAreLost) {
  const std::vector<std::vector<double>> bump{{0, 4, -4}};
  for (const SurfaceMethod method :
       {SurfaceMethod::every_crossing, SurfaceMethod::nearest_normal, SurfaceMethod::nearest_only,
        SurfaceMethod::one_per_step, SurfaceMethod::peak_finding, SurfaceMethod::threshold})
    EXPECT_TRUE(found_by(method, {0, 1}, bump, {0.5}, 0.25).empty());
  EXPECT_EQ(surface_hits(precise_piecewise_polynomial({0, 1}, bump), {0.5}).hits.size(), 2U);
}

/// Three steps of regula falsi come nearer than the line.
TEST(SurfaceMethod, PeakFindingLooksAtTheSignal) {
  const std::vector<std::vector<double>> square{{0, 0, 1}};
  const double line = found_by(SurfaceMethod::every_crossing, {0, 1}, square, {0.25}).at(0).first;
  const double peak = found_by(SurfaceMethod::peak_finding, {0, 1}, square, {0.25}).at(0).first;
  EXPECT_EQ(line, 0.25);
  // By hand: 1/4, 2/5, 13/28.
  EXPECT_NEAR(peak, 13.0 / 28, 1e-15);
}

/// A sample on a surface is above it: a touch from below is crossed twice, one from above not at all.
TEST(SurfaceMethod, ASampleOnASurfaceIsAboveIt) {
  const std::vector<double> to_two{0, 1, 2};
  EXPECT_EQ(found_by(SurfaceMethod::every_crossing, to_two, {{0, 1}, {1, -1}}, {1}).size(), 2U);
  EXPECT_TRUE(found_by(SurfaceMethod::every_crossing, to_two, {{1, -1}, {0, 1}}, {0}).empty());
}

/// The first crossing's normal lights all of a slab; the others have their own.
TEST(SurfaceMethod, WhereNormalsAreTaken) {
  const auto signal = piecewise_polynomial(breaks, trapezoid);
  Samples<double> samples;
  sample_constant(signal, 1.0, samples);
  for (const SampledHit& hit : sampled_hits(SurfaceMethod::nearest_normal, signal, samples, three))
    EXPECT_EQ(hit.normal_t, hit.interval == 0 ? 0.25 : 2.25);
  for (const SampledHit& hit : sampled_hits(SurfaceMethod::every_crossing, signal, samples, three))
    EXPECT_EQ(hit.normal_t, hit.t);
}

}  // namespace
}  // namespace raytruth
