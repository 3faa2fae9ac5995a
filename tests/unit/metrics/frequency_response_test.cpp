#include "raytruth/metrics/frequency_response.hpp"

#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <numbers>

namespace raytruth {
namespace {

using Complex = std::complex<double>;

constexpr double pi = std::numbers::pi;

const std::vector<ReconstructionPath> paths{{false, {}}, {false, 0.0}, {false, 0.3}, {false, 0.5},
                                            {true, {}},  {true, 0.0},  {true, 0.3},  {true, 0.5}};

// The kernels as their papers print them, unlike the Bernstein coefficients of the code under test.

double bspline_kernel(double x) {
  const double a = std::abs(x);
  if (a < 1) return (4 - 6 * a * a + 3 * a * a * a) / 6;
  return a < 2 ? (2 - a) * (2 - a) * (2 - a) / 6 : 0;
}

/// Keys 1981, eq. 15.
double catmull_rom_kernel(double x) {
  const double a = std::abs(x);
  if (a < 1) return 1.5 * a * a * a - 2.5 * a * a + 1;
  return a < 2 ? -0.5 * a * a * a + 2.5 * a * a - 4 * a + 2 : 0;
}

/// What the spline makes of an impulse; prefiltered, coefficient k is sqrt(3) (sqrt(3) - 2)^|k|.
double spline(const ReconstructionPath& path, double x) {
  if (!path.prefiltered) return bspline_kernel(x);
  double sum = 0;
  for (int k = static_cast<int>(std::floor(x)) - 1; k <= static_cast<int>(std::floor(x)) + 2; ++k)
    sum += std::sqrt(3.0) * std::pow(std::sqrt(3.0) - 2, std::abs(k)) * bspline_kernel(x - k);
  return sum;
}

double signal(const ReconstructionPath& path, double x) {
  if (!path.virtual_phase) return spline(path, x);
  const double phase = *path.virtual_phase;
  double sum = 0;
  const int nearest = static_cast<int>(std::floor(x - phase));
  for (int k = nearest - 1; k <= nearest + 2; ++k) sum += spline(path, k + phase) * catmull_rom_kernel(x - phase - k);
  return sum;
}

Complex transform_by_quadrature(const ReconstructionPath& path, double f) {
  const double first = path.virtual_phase.value_or(0) - 32;
  Complex sum;
  for (int piece = 0; piece < 64; ++piece) {
    const auto part = [&](auto&& wave) {
      const auto integrand = [&](double x) { return signal(path, x) * wave(2 * pi * f * x); };
      // Open at the ends, where the next polynomial begins.
      return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, first + piece, first + piece + 1,
                                                                           0, 0);
    };
    sum += Complex(part([](double x) { return std::cos(x); }), -part([](double x) { return std::sin(x); }));
  }
  return sum;
}

TEST(FrequencyResponse, IsTheFourierIntegral) {
  for (const auto& path : paths)
    for (const double f : {0.0, 0.07, 0.25, 0.5, 0.81, 1.0, 1.23, 1.5, 1.9, 2.0, -0.3})
      EXPECT_LT(std::abs(frequency_response(path, f) - transform_by_quadrature(path, f)), 4e-14)
          << path.prefiltered << ' ' << path.virtual_phase.value_or(-1) << ' ' << f;
}

TEST(FrequencyResponse, KeepsConstantsAndWholeFrequenciesVanish) {
  for (const auto& path : paths) {
    EXPECT_NEAR(std::abs(frequency_response(path, 0)), 1, 1e-15);
    EXPECT_EQ(std::abs(frequency_response(path, 1)), 0);
    EXPECT_EQ(std::abs(frequency_response(path, 2)), 0);
  }
}

TEST(FrequencyResponse, MeetsTheSplineOrNothingAtHalfACycle) {
  const double level = std::pow(2 / pi, 4);
  EXPECT_NEAR(std::abs(frequency_response({false, {}}, 0.5)), level, 1e-15);
  EXPECT_NEAR(std::abs(frequency_response({false, 0.0}, 0.5)), level, 1e-15);
  EXPECT_NEAR(std::abs(frequency_response({false, 0.5}, 0.5)), 0, 1e-15);
}

TEST(ImpulseResponse, IsTheClosedFormWithinItsBounds) {
  for (const auto& path : paths)
    for (const int samples_per_voxel : {3, 4, 64}) {
      const ImpulseResponse impulse(path, samples_per_voxel);
      EXPECT_LT(impulse.radius(), 1e-10);
      EXPECT_LT(impulse.aliases(), samples_per_voxel == 64 ? 3e-6 : 1);
      for (int i = 0; i <= 32; ++i) {
        const double f = i / 16.0;
        EXPECT_LE(std::abs(impulse.at(f) - frequency_response(path, f)), impulse.aliases() + impulse.radius() + 1e-14)
            << path.prefiltered << ' ' << path.virtual_phase.value_or(-1) << ' ' << f;
      }
    }
}

TEST(ImpulseResponse, DiffersByItsAliasesAndByNothingElse) {
  for (const auto& path : paths) {
    const ImpulseResponse impulse(path, 4);
    for (const double f : {0.1, 0.5, 1.3, 1.9}) {
      Complex sum;
      const double first = path.virtual_phase.value_or(0);
      for (int n = -4000; n <= 4000; ++n)
        sum += frequency_response(path, f + 4 * n) * std::polar(1.0, 2 * pi * 4 * n * first);
      EXPECT_LT(std::abs(impulse.at(f) - sum), 1e-11);
    }
  }
}

TEST(ImpulseResponse, RefusesSamplesTooFarApart) { EXPECT_THROW(ImpulseResponse({}, 2), InputError); }

}  // namespace
}  // namespace raytruth
