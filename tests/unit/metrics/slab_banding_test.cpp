#include "raytruth/metrics/slab_banding.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace raytruth {
namespace {

constexpr std::array<std::int64_t, 2> square{72, 72};
constexpr std::int64_t side = 24;

using Function = std::function<double(double column, double row)>;

std::vector<double> image_of(const Function& f) {
  std::vector<double> values;
  for (std::int64_t row = 0; row < square[1]; ++row)
    for (std::int64_t column = 0; column < square[0]; ++column)
      values.push_back(f(static_cast<double>(column), static_cast<double>(row)));
  return values;
}

/// The values of `of_phase` of the depths' fractions, and of `rest`.
std::optional<SlabBanding> banding_of(const Function& depth, const std::function<double(double)>& of_phase,
                                      const Function& rest) {
  return slab_banding(image_of([&](double column, double row) {
                        const double slabs = depth(column, row);
                        return of_phase(slabs - std::floor(slabs)) + rest(column, row);
                      }),
                      image_of(depth), square, side);
}

double none(double /*column*/, double /*row*/) { return 0; }
double no_phase(double /*phase*/) { return 0; }
double saw_tooth(double phase) { return phase - 0.5; }
double sine(double phase) { return std::sin(2 * std::numbers::pi * phase); }

/// Between 0 and 1, of variance 1/12.
double noise(double column, double row) {
  return random_numbers(1, RandomStream::points, static_cast<std::uint64_t>(row * 1000 + column))[0];
}

/// A plane whose slabs are `period` pixels wide, across a direction of so many degrees.
Function plane(double period, double degrees) {
  const double radians = degrees * std::numbers::pi / 180;
  return [=](double column, double row) {
    return 100.3 + (std::cos(radians) * column + std::sin(radians) * row) / period;
  };
}

/// A ball in front of the camera: its slabs are rings, which become narrow outside.
double ball(double column, double row) {
  const double square_of_radius = (column - 30) * (column - 30) + (row - 40) * (row - 40);
  return 50 - std::sqrt(std::max(0.0, 100 * 100 - square_of_radius)) / 3;
}

TEST(SlabBanding, IsAllOfStripesOfAnyPeriodDirectionAndAmplitude) {
  for (const double period : {3.7, 5.3, 8.3, 11.3})
    for (const double degrees : {0.0, 30.0, 45.0, 90.0, 117.0})
      for (const double amplitude : {1e-4, 0.05, 3.0}) {
        const auto found = banding_of(
            plane(period, degrees), [=](double phase) { return amplitude * saw_tooth(phase); }, none);
        ASSERT_TRUE(found) << period << ' ' << degrees;
        EXPECT_NEAR(found->share, 1, 1e-9) << period << ' ' << degrees;
        // The root mean square of a saw-tooth of this height, at the phases of the pixels that there are.
        EXPECT_NEAR(found->amplitude, amplitude / std::sqrt(12), 0.06 * amplitude) << period << ' ' << degrees;
        EXPECT_NEAR(found->jump, amplitude, 1e-9 * amplitude) << period << ' ' << degrees;
      }
}

TEST(SlabBanding, IsAllOfRings) {
  const auto found = banding_of(ball, saw_tooth, none);
  ASSERT_TRUE(found);
  EXPECT_GT(found->windows, 0);
  EXPECT_NEAR(found->share, 1, 1e-9);
  EXPECT_NEAR(found->jump, 1, 1e-9);
}

TEST(SlabBanding, OfContinuousStripesHasNoJump) {
  for (const double shift : {0.0, 0.1, 0.25}) {
    const auto found = banding_of(
        plane(6.3, 20), [=](double phase) { return sine(phase + shift); }, none);
    ASSERT_TRUE(found);
    EXPECT_GT(found->share, 0.99);
    EXPECT_NEAR(found->amplitude, 1 / std::numbers::sqrt2, 0.03);
    EXPECT_LT(found->jump, 0.1);
  }
  const auto parabola = banding_of(
      plane(6.3, 20), [](double phase) { return phase * (1 - phase); }, none);
  ASSERT_TRUE(parabola);
  EXPECT_NEAR(parabola->share, 1, 1e-9);
  EXPECT_LT(parabola->jump, 1e-9);
}

TEST(SlabBanding, IsNoneOfNoise) {
  // A phase's polynomials take 5 of some 570 numbers of a window off at random, and so do their degrees of freedom.
  for (const Function& depth : {plane(5, 30), plane(8.3, 90), Function(ball)}) {
    const auto found = banding_of(depth, no_phase, noise);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->share, 0, 0.01);
    // The jump of a window has a standard deviation of sqrt(84 / 12 / 576) = 0.11, the mean of their squares over some
    // dozen independent windows one of 0.11^2 sqrt(2 / 12) = 0.07^2.
    EXPECT_LT(found->jump, 2 * 0.07);
  }
}

TEST(SlabBanding, IsNoneOfWhatVariesSmoothly) {
  EXPECT_EQ(banding_of(plane(5, 30), no_phase, [](double, double) { return 2; })->share, 0);
  EXPECT_EQ(banding_of(plane(5, 30), no_phase, [](double x, double y) { return x * y - x * x / 7; })->share, 0);
  const auto found =
      banding_of(plane(5, 30), no_phase, [](double x, double y) { return std::exp(x / 20) * std::cos(y / 15); });
  EXPECT_NEAR(found->share, 0, 0.02);
}

TEST(SlabBanding, IsNoneOfStripesThatDoNotKeepToTheSlabs) {
  // The voxels' own stripes: another period along the same direction, or the same period along another one.
  const auto with_stripes = [](const Function& stripes) {
    return banding_of(plane(5, 30), no_phase, [=](double x, double y) { return sine(stripes(x, y)); });
  };
  EXPECT_NEAR(with_stripes(plane(7.7, 30))->share, 0, 0.03);
  EXPECT_NEAR(with_stripes(plane(5, 100))->share, 0, 0.03);
}

TEST(SlabBanding, OfStripesInNoiseIsTheirShareAtAnyAmplitude) {
  // Variances: a quarter of noise's, the same, four times it. The noise's mean square grows, the jump does not.
  for (const double height : {0.5, 1.0, 2.0})
    for (const double factor : {1e-3, 1.0}) {
      const auto found = banding_of(
          plane(6.3, 20), [=](double phase) { return factor * height * saw_tooth(phase); },
          [=](double x, double y) { return factor * noise(x, y) + factor * (x * y / 50 - y); });
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->share, height * height / (height * height + 1), 0.03) << height;
      EXPECT_NEAR(found->jump, factor * height, factor * 0.1) << height;
      EXPECT_NEAR(found->amplitude, factor * height / std::sqrt(12), factor * 0.02) << height;
    }
}

TEST(SlabBanding, IsNotToldWhereSlabsAreWiderThanWindowsOrNarrowerThanTwoPixels) {
  EXPECT_FALSE(banding_of(plane(40, 30), saw_tooth, none));
  EXPECT_FALSE(banding_of(plane(1.5, 30), saw_tooth, none));
  EXPECT_FALSE(banding_of([](double, double) { return 3.25; }, saw_tooth, noise));
  // Five phases in all: polynomials of degree 5 are not told apart.
  EXPECT_FALSE(banding_of(plane(5, 0), saw_tooth, none));
  EXPECT_FALSE(banding_of([](double, double) { return std::numeric_limits<double>::quiet_NaN(); }, no_phase, noise));
  // Two flat surfaces, of which smooth functions tell much, but not all.
  EXPECT_FALSE(banding_of([](double x, double) { return x < 30 ? 3.25 : 7.75; }, saw_tooth, noise));
}

TEST(SlabBanding, RefusesWindowsThatDoNotFit) {
  EXPECT_THROW(slab_banding(image_of(noise), image_of(noise), square, 73), InputError);
  EXPECT_THROW(slab_banding(image_of(noise), image_of(noise), square, 4), InputError);
}

}  // namespace
}  // namespace raytruth
