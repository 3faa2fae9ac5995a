#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "unit/support/exact_ray.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <limits>

namespace raytruth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

template <class Real>
void sample(const Chain<3, Real>& signal, std::optional<double> step, Samples<Real>& samples) {
  if (step)
    sample_constant(signal, Real(*step), samples);
  else
    sample_cells(signal, samples);
}

/// xi and xi_max of a scheme, the whole way in one arithmetic.
template <class S, class Real>
std::pair<Real, Real> errors(const Chain<3, Real>& signal, std::optional<double> step) {
  Samples<Real> samples;
  sample(signal, step, samples);
  Chain<3, Real> approximation;
  approximate<S>(signal, samples, approximation);
  return {xi(signal, approximation), xi_max(signal, approximation)};
}

TEST(SignalError, StaysWithinItsRadiusOf50Digits) {
  const Grid grid = random_field(16, 0, 4);
  const double length = 8.5;
  double worst = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const Ray ray = random_ray(grid, length, 2, i);
    const Chain<3> signal = trace_trilinear(grid, ray);
    const Chain<3, Real50> exact = testing_support::exact_chain(grid, ray);
    for (const std::optional<double> step : {std::optional<double>{}, std::optional<double>{0.5}})
      catalogue::for_each_scheme([&]<class S>() {
        if (!refusal<S>(Samples<double>{.positions = {}, .values = {}, .step = step}).empty()) return;
        const auto found = errors<S>(signal, step);
        const auto truth = errors<S>(exact, step);
        worst = std::max(worst, std::abs(found.first - to_double(truth.first)) / length);
        worst = std::max(worst, std::abs(found.second - to_double(truth.second)));
      });
  }
  EXPECT_LE(worst, signal_radius);
}

TEST(SignalError, AgreesWithAdaptiveQuadrature) {
  const Grid grid = random_field(16, 1, 4);
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Ray ray = random_ray(grid, 5, 2, i);
    const Chain<3> signal = trace_trilinear(grid, ray);
    Samples<double> samples;
    sample_constant(signal, 0.7, samples);
    Chain<3> approximation;
    approximate<Order2>(signal, samples, approximation);
    const auto direction = unit_direction(ray.direction);
    const auto difference = [&](double t) {
      const std::array<double, 3> point{ray.origin[0] + t * direction[0], ray.origin[1] + t * direction[1],
                                        ray.origin[2] + t * direction[2]};
      return std::abs(trilinear_value(grid, point) - approximation.value(t));
    };
    using Quadrature = boost::math::quadrature::gauss_kronrod<double, 61>;
    double sum = 0;
    for (int k = 0; k < 50; ++k) sum += Quadrature::integrate(difference, 0.1 * k, 0.1 * (k + 1), 15, 1e-9);
    EXPECT_NEAR(xi(signal, approximation), sum, 1e-12 * sum);
  }
}

TEST(SignalError, ClosedForm) {
  // s = t^3 on [0, 2], sampled at 0, 1, 2: order 1 gives t and 7t - 6, order 2 the parabola 3t^2 - 2t.
  Chain<3> signal;
  signal.pieces.push_back({0.0, 2, {{0, 0, 0, 8}}});
  signal.end = 2.0;
  EXPECT_NEAR((errors<Order1>(signal, 1.0).first), 0.25 + 0.75, 8 * epsilon);
  EXPECT_NEAR((errors<Order2>(signal, 1.0).first), 0.5, 4 * epsilon);
  // |t (t - 1) (t - 2)| is largest at 1 +- 1/sqrt(3).
  EXPECT_NEAR((errors<Order2>(signal, 1.0).second), 2 / (3 * std::sqrt(3.0)), 4 * epsilon);
  EXPECT_NEAR((errors<Order0Left>(signal, 1.0).first), 4.0 - 1.0, 8 * epsilon);
  EXPECT_EQ((errors<Order0Left>(signal, 1.0).second), 7.0);
}

TEST(SignalError, SecondOrderIsExactOnMarschnerLobb) {
  // Separable, so no cubic term: a degenerate test for samples at cell borders and midpoints.
  const Grid grid = sampled_marschner_lobb(41);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 8.5, 1, i));
    EXPECT_LE((errors<Order2>(signal, std::nullopt).first), signal_radius * 8.5);
    EXPECT_GT((errors<Order1>(signal, std::nullopt).first), 1e-6);
  }
}

}  // namespace
}  // namespace raytruth
