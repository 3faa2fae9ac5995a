#include "raytruth/signals/analytic.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/statistics/order.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace raytruth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

const AnalyticSignal& signal_named(std::string_view name) {
  for (const AnalyticSignal& signal : analytic_signals())
    if (signal.name == name) return signal;
  throw InputError("no such signal");
}

/// The order of xi at constant steps 2^-3 ... 2^-7.
template <class S>
double order_on(const AnalyticSignal& analytic) {
  const Chain<9> signal = expand(analytic);
  std::vector<StepError> points;
  Samples<double> samples;
  Chain<3> approximation;
  for (int k = 3; k <= 7; ++k) {
    sample_constant(signal, std::ldexp(1.0, -k), samples);
    approximate<S>(signal, samples, approximation);
    points.push_back({std::ldexp(1.0, -k), xi(signal, approximation)});
  }
  return fit_order(points).order;
}

TEST(AnalyticSignals, ChainsMeetTheirFormulas) {
  std::set<std::string_view> names;
  for (const AnalyticSignal& analytic : analytic_signals()) {
    SCOPED_TRACE(analytic.name);
    EXPECT_TRUE(names.insert(analytic.name).second);
    EXPECT_FALSE(analytic.character.empty());
    const Chain<9> chain = expand(analytic);
    EXPECT_EQ(chain.length(), analytic.length);
    for (int i = 0; i <= 5000; ++i) {
      const double t = analytic.length * i / 5000;
      EXPECT_NEAR(chain.value(t), analytic.value(t), 2 * expansion_tolerance);
    }
    EXPECT_LE(chain.pieces.size(), 512U);
  }
}

TEST(AnalyticSignals, SmoothOnesShowTheOrderOfEveryScheme) {
  catalogue::for_each_scheme([]<class S>() {
    SCOPED_TRACE(S::info.name);
    for (const char* name : {"sine_slow", "gaussian_wide"})
      EXPECT_NEAR(order_on<S>(signal_named(name)), S::info.order, 0.1);
  });
}

TEST(AnalyticSignals, CharactersHold) {
  // A jump leaves order 1, a corner order 2, whatever the scheme's own order.
  EXPECT_NEAR(order_on<Order2>(signal_named("step_between_samples")), 1, 0.3);
  EXPECT_NEAR(order_on<Order2>(signal_named("kink_between_samples")), 2, 0.3);
  EXPECT_NEAR(order_on<VirtualCatmullRom>(signal_named("kink_between_samples")), 2, 0.3);
}

TEST(AnalyticSignals, RefusesAFormulaThatIsNotFinite) {
  EXPECT_THROW(expand([](double t) { return 1 / (t - t); }, {}, 1), InputError);
}

TEST(MarschnerLobbRay, MeetsTheFormula) {
  const Ray ray{{-2, 0.1, 0.2}, {1, 0.05, -0.1}};
  const Chain<9> chain = trace_marschner_lobb(ray);
  const auto direction = unit_direction(ray.direction);
  const double entry = 1 / direction[0];
  EXPECT_NEAR(chain.length(), 2 / direction[0], 4 * epsilon);
  for (int i = 0; i <= 1000; ++i) {
    const double t = chain.length() * i / 1000;
    EXPECT_NEAR(chain.value(t),
                marschner_lobb(ray.origin[0] + (entry + t) * direction[0], ray.origin[1] + (entry + t) * direction[1],
                               ray.origin[2] + (entry + t) * direction[2]),
                2 * expansion_tolerance);
  }
  EXPECT_LE(chain.pieces.size(), 512U);
  EXPECT_TRUE(trace_marschner_lobb({{-2, 3, 0}, {1, 0, 0}}).pieces.empty());
  EXPECT_TRUE(trace_marschner_lobb({{-2, 0, 0}, {-1, 0, 0}}).pieces.empty());
  EXPECT_THROW(trace_marschner_lobb({{0, 0, 0}, {0, 0, 0}}), InputError);
}

}  // namespace
}  // namespace raytruth
