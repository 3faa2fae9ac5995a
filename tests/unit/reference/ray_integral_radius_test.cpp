#include "raytruth/core/real50.hpp"
#include "raytruth/reference/linear_interval.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>

// Every term of the radius is needed, and none is far too large: rays that differ by as much as a signal's error
// allows, under optics that make one term alone speak. Colours are bright, so that the light is not covered by what
// covers the opacity.
namespace raytruth {
namespace {

constexpr double bright = 1000;

/// The largest difference of their colours and opacities.
double difference(const Certified& a, const Certified& b) {
  return std::max((a.color - b.color).abs().maxCoeff(), std::abs(a.opacity - b.opacity));
}

/// The radius covers what the signal may be instead, and is at most `most` times as much.
template <int Degree>
void expect_tight_cover(const PiecewiseLinear& transfer, Emission emission, const Chain<Degree>& signal,
                        const SignalError& error, const Chain<Degree>& instead, double most = 10) {
  const Certified answer = RayIntegral(transfer, emission)(signal, error);
  const double seen = difference(answer, RayIntegral(transfer, emission)(instead));
  EXPECT_LE(seen, answer.radius);
  EXPECT_LE(answer.radius, most * seen + 1e-12 * bright);
}

TEST(RayIntegralRadius, CoversALengthThatIsNotKnown) {
  const SignalError error{.of_pieces = {}, .of_length = 1e-6};
  for (const double color : {0.0, bright})
    for (const Emission emission : both_emissions)
      for (const double change : {1e-6, -1e-6})
        expect_tight_cover(PiecewiseLinear({{0, {0.5, {color, color / 2, 0}}}}), emission, constant(0.5, 1), error,
                           constant(0.5, 1 + change));
}

/// A ray whose front half is dark but for a part of this length at its end.
Chain<3> with_a_part(double scalar, double length) {
  return {{{0.0, 0.5 - length, {{0, 0, 0, 0}}},
           {0.5 - length, length, {{scalar, scalar, scalar, scalar}}},
           {0.5, 0.5, {{1, 1, 1, 1}}}},
          1};
}

TEST(RayIntegralRadius, CoversPartsOfWhichNothingIsKnown) {
  // In front of what shines: matter that shines, and matter that only hides.
  const PiecewiseLinear shining({{0, {0, {bright, 0, 0}}}, {0.5, {0.5, {bright, 0, 0}}}, {1, {0, {bright, 0, 0}}}});
  const PiecewiseLinear hiding({{0, {0, {0, 0, 0}}}, {0.5, {4, {0, 0, 0}}}, {1, {4, {bright, 0, 0}}}});
  const PiecewiseLinear dark({{0, {0, {0, 0, 0}}}, {0.5, {1, {0, 0, 0}}}, {1, {0, {0, 0, 0}}}});
  const SignalError error{.of_pieces = {}, .of_length = 0, .unclaimed = 1e-6};
  for (const PiecewiseLinear& transfer : {shining, hiding, dark})
    expect_tight_cover(transfer, Emission::associated, with_a_part(0, 1e-6), error, with_a_part(0.5, 1e-6));
  for (const PiecewiseLinear& transfer : {hiding, dark})
    expect_tight_cover(transfer, Emission::plain, with_a_part(0, 1e-6), error, with_a_part(0.5, 1e-6));
}

TEST(RayIntegralRadius, CoversMatterBeyondAJumpThatTheScalarMayReach) {
  // Bright on both sides: what is wrong is the extinction alone.
  const PiecewiseLinear jump(
      {{0, {0, {bright, 0, 0}}}, {0.5, {0, {bright, 0, 0}}}, {0.5, {2, {bright, 0, 0}}}, {1, {2, {bright, 0, 0}}}});
  constexpr double off = 1e-7;
  const SignalError error{.of_pieces = {off}, .exact_ends = {false}};
  for (const auto& [front, back] : {std::pair{0.2, 0.8}, {0.8, 0.2}})
    for (const double sign : {1.0, -1.0})
      // The stretches on both sides of the jump count, and in each the source there and what is seen through it.
      expect_tight_cover(jump, Emission::associated, linear(front, back), error,
                         linear(front + sign * off, back + sign * off), 20);
}

TEST(RayIntegralRadius, CoversMatterBeyondAJumpWhereARayBegins) {
  // What hides, or shines, only beyond the jump; the rest of the ray is one stretch.
  const Optics clear{0, {bright, 0, 0}};
  const Optics misty{2, {bright, 0, 0}};
  const Optics dark{2, {0, 0, 0}};
  constexpr double off = 1e-7;
  const SignalError error{.of_pieces = {off}, .exact_ends = {false}};
  for (const auto& [below, above] : {std::pair{clear, misty}, {misty, clear}, {misty, dark}, {dark, misty}})
    for (const Emission emission : both_emissions)
      expect_tight_cover(PiecewiseLinear({{0, below}, {0.5, below}, {0.5, above}, {1, above}}), emission,
                         linear(0.5, 0.75), error, linear(0.5 - off, 0.75 - off), 20);
}

TEST(RayIntegralRadius, CoversMatterBehindAThinIntervalThatTheScalarMayLeap) {
  // Within the thin interval nothing is there; behind it is more than any slope at its ends tells.
  constexpr double thin = 0x1p-30;
  constexpr double off = 0x1p-27;
  const PiecewiseLinear transfer({{0, {0, {1, 0, 0}}},
                                  {0.5, {0, {1, 0, 0}}},
                                  {0.5 + thin, {0, {1, 0, 0}}},
                                  {0.5 + thin, {1000, {1, 0, 0}}},
                                  {1, {1000, {1, 0, 0}}}});
  const SignalError error{.of_pieces = {off}, .exact_ends = {false}};
  for (const Emission emission : both_emissions)
    expect_tight_cover(transfer, emission, linear(0.375, 0.5), error, linear(0.375 + off, 0.5 + off));
}

TEST(LinearIntervals, AnEndReachesAsFarAsItsNeighbour) {
  const PiecewiseLinear transfer(
      {{0, {0, {1, 1, 1}}}, {1, {1, {1, 1, 1}}}, {1.25, {5, {1, 1, 1}}}, {3, {0, {1, 1, 1}}}});
  const LinearIntervals intervals(transfer);
  EXPECT_EQ(intervals[1].end_0.reach, HUGE_VAL);  // a half-line
  EXPECT_NEAR(intervals[1].end_1.reach, 0.25, 1e-6);
  EXPECT_LE(intervals[1].end_1.reach, 0.25);
  EXPECT_NEAR(intervals[2].end_0.reach, 4, 1e-5);
  EXPECT_NEAR(intervals[2].end_1.reach, 7, 1e-5);
  EXPECT_EQ(intervals[3].end_1.reach, HUGE_VAL);
}

}  // namespace
}  // namespace raytruth
