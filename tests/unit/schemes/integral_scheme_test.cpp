#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/schemes/cell_adaptive.hpp"
#include "raytruth/schemes/sampled_march.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/schemes/slab_integrals.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/statistics/order.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss.hpp>

#include <cmath>
#include <map>
#include <set>
#include <string>

// One loop over the catalogue for each property: a scheme is tested by being in it.

namespace raytruth {
namespace {

constexpr std::array both{Emission::associated, Emission::plain};

/// Linear on a range that no scheme leaves here.
PiecewiseLinear smooth_transfer(double scale = 1) {
  return PiecewiseLinear({{-1, {0.2 * scale, {0.9, 0.1, 0.4}}}, {2, {3.2 * scale, {0.3, 1, 0.6}}}});
}

PiecewiseLinear random_transfer(std::uint64_t seed, double scale) {
  std::vector<TransferPoint> points;
  for (std::uint32_t i = 0; i < 33; ++i) {
    const auto [extinction, red, green, blue] = random_numbers(seed, RandomStream::points, i);
    points.push_back({i / 32.0, {scale * extinction, {red, green, blue}}});
  }
  return PiecewiseLinear(points);
}

/// One smooth piece on [0, 3], values in [0, 1].
Chain<9> smooth_signal() {
  Chain<9> chain;
  Bernstein<9> p;
  for (std::size_t i = 0; i <= 9; ++i) p.coefficients[i] = random_numbers(12, RandomStream::points, i / 4)[i % 4];
  chain.pieces.push_back({0.0, 3.0, p});
  chain.end = 3.0;
  return chain;
}

Chain<3> noise_ray(std::uint64_t index, double length = 8.3) {
  static const Grid grid = random_field(16, 0, 1);
  return trace_trilinear(grid, random_ray(grid, length, 1, index));
}

template <int Degree>
Samples<double> at_step(const Chain<Degree>& signal, double step) {
  Samples<double> samples;
  sample_constant(signal, step, samples);
  return samples;
}

TEST(IntegralSchemes, HaveNamesSignalsAndStyles) {
  std::set<std::string_view> names;
  std::set<std::pair<std::string_view, std::string_view>> styles;
  std::size_t styled = 0;
  for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
    SCOPED_TRACE(scheme.name);
    EXPECT_TRUE(names.insert(scheme.name).second);
    EXPECT_EQ(find_named(catalogue::integral_schemes(), scheme.name), &scheme);
    EXPECT_FALSE(scheme.summary.empty());
    EXPECT_FALSE(scheme.source.empty());
    EXPECT_TRUE(scheme.signal.empty() || catalogue::visit_scheme(scheme.signal, []<class S>() {}));
    if (std::holds_alternative<Iterations>(scheme.method)) continue;  // drawn over their number
    styles.emplace(scheme.color, scheme.marker);
    ++styled;
  }
  EXPECT_EQ(styles.size(), styled);
  EXPECT_EQ(find_named(catalogue::integral_schemes(), "order4"), nullptr);
  catalogue::for_each_scheme([]<class S>() {
    const IntegralScheme* scheme = find_named(catalogue::integral_schemes(), S::info.name);
    ASSERT_NE(scheme, nullptr);
    EXPECT_EQ(family(*scheme), "ideal");
  });
}

TEST(EveryIntegralScheme, MakesNothingOfNothing) {
  const Chain<3> empty;
  for (const Emission emission : both) {
    SchemeIntegral integrate(smooth_transfer(), emission);
    for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
      SCOPED_TRACE(scheme.name);
      const Outcome<> outcome = integrate(scheme, empty, at_step(empty, 0.5));
      EXPECT_TRUE(outcome.refusal.empty());
      EXPECT_EQ(outcome.opacity, 0);
      EXPECT_TRUE((outcome.color == 0).all());
      EXPECT_EQ(outcome.fetches + outcome.voxels + outcome.lookups + outcome.composites, 0);
    }
  }
}

TEST(EveryIntegralScheme, HasAnOpacityFrom0To1) {
  for (const double scale : {1e-12, 1.0, 1e5}) {
    SchemeIntegral integrate(random_transfer(3, scale), Emission::associated);
    for (std::uint64_t i = 0; i < 5; ++i) {
      const Chain<3> signal = noise_ray(i);
      for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
        SCOPED_TRACE(scheme.name);
        const Outcome<> outcome = integrate(scheme, signal, at_step(signal, 0.5));
        EXPECT_TRUE(outcome.refusal.empty());
        EXPECT_GT(outcome.opacity, 0);
        EXPECT_LE(outcome.opacity, 1);
        EXPECT_TRUE((outcome.color >= 0).all());
      }
    }
  }
}

TEST(EveryIntegralScheme, IsExactOnConstantsIfItSaysSo) {
  Chain<3> constant;
  constant.pieces = {{0.0, 1.5, {{0.5, 0.5, 0.5, 0.5}}}, {1.5, 2.25, {{0.5, 0.5, 0.5, 0.5}}}};
  constant.end = 3.75;
  const Optics optics = smooth_transfer().at(0.5);
  const double opacity = -std::expm1(-3.75 * optics.extinction);
  for (const Emission emission : both) {
    const Vector3<double> color =
        emission == Emission::associated ? optics.color * opacity : optics.color * (opacity / optics.extinction);
    SchemeIntegral integrate(smooth_transfer(), emission);
    for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
      SCOPED_TRACE(scheme.name);
      const Outcome<> outcome = integrate(scheme, constant, at_step(constant, 0.5));
      const double error = (outcome.color - color).abs().maxCoeff();
      if (scheme.is_exact_on_constants) {
        EXPECT_LE(error, 2e-15);
        EXPECT_NEAR(outcome.opacity, opacity, 1e-15);
      } else {
        EXPECT_GE(error, 1e-4);
      }
    }
  }
}

TEST(EveryIntegralScheme, HasItsOrders) {
  const Chain<9> signal = smooth_signal();
  for (const Emission emission : both) {
    const Certified truth = RayIntegral(smooth_transfer(), emission)(signal);
    SchemeIntegral integrate(smooth_transfer(), emission);
    for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
      SCOPED_TRACE(scheme.name + (emission == Emission::plain ? ", plain" : ", associated"));
      if (scheme.order.color == 0) continue;
      const auto* iterations = std::get_if<Iterations>(&scheme.method);
      if (iterations != nullptr && iterations->count > 8) continue;  // they need finer steps to show their order
      // Multiples of six intervals: pairs and triples come out even. Steps small enough for the ends of a ray, at which
      // Catmull-Rom has an error of its own, and large enough for errors a hundred radii above the truth's.
      const bool is_high = scheme.order.color > 2 || scheme.order.opacity > 2;
      std::vector<StepError> color_errors;
      std::vector<StepError> opacity_errors;
      for (int k = is_high ? 4 : 5; k <= (is_high ? 6 : 8); ++k) {
        const double step = 3.0 / (6 << k);
        const Outcome<> outcome = integrate(scheme, signal, at_step(signal, step));
        ASSERT_TRUE(outcome.refusal.empty());
        color_errors.push_back({step, std::abs(outcome.color[1] - truth.color[1])});
        opacity_errors.push_back({step, std::abs(outcome.opacity - truth.opacity)});
      }
      EXPECT_NEAR(fit_order(color_errors).order, scheme.order.color, 0.1);
      EXPECT_LE(fit_order(color_errors).residual, 0.1);
      EXPECT_NEAR(fit_order(opacity_errors).order, scheme.order.opacity, 0.1);
      EXPECT_LE(fit_order(opacity_errors).residual, 0.1);
    }
  }
}

TEST(EveryIntegralScheme, ScalesWithUnitsBitByBit) {
  for (std::uint64_t i = 0; i < 5; ++i) {
    const Chain<3> signal = noise_ray(i);
    Chain<3> longer = signal;
    longer.end = {signal.end.high * 8, signal.end.low * 8};
    for (auto& piece : longer.pieces) {
      piece.start = {piece.start.high * 8, piece.start.low * 8};
      piece.length *= 8;
    }
    for (const Emission emission : both) {
      SchemeIntegral integrate(random_transfer(3, 1), emission);
      SchemeIntegral integrate_longer(random_transfer(3, 0.125), emission);
      for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
        SCOPED_TRACE(scheme.name);
        // As printed radii stand at 2^-3 to 2^3 voxels, whatever a voxel is.
        if (scheme.name == "quadratic_gray_printed") continue;
        const Outcome<> outcome = integrate(scheme, signal, at_step(signal, 0.5));
        const Outcome<> scaled = integrate_longer(scheme, longer, at_step(longer, 4));
        const double factor = emission == Emission::associated ? 1 : 8;
        EXPECT_EQ(scaled.opacity, outcome.opacity);
        EXPECT_TRUE((scaled.color == factor * outcome.color).all());
      }
    }
  }
}

TEST(EveryIntegralScheme, CountsWhatItReadsAndDoes) {
  Chain<3> signal;
  signal.pieces = {{0.0, 1.25, {{0, 0.1, 0.2, 0.3}}}, {1.25, 1.25, {{0.3, 0.1, 0.2, 0.9}}}};
  signal.end = 2.5;
  SchemeIntegral integrate(smooth_transfer(), Emission::associated);
  const auto counts = [&](std::string_view name) {
    const Outcome<> outcome =
        integrate(*find_named(catalogue::integral_schemes(), name), signal, at_step(signal, 0.25));
    return std::array{outcome.fetches, outcome.lookups, outcome.composites};
  };
  using Counts = std::array<std::int64_t, 3>;
  EXPECT_EQ(counts("riemann_left"), (Counts{10, 10, 10}));
  EXPECT_EQ(counts("riemann_mid_linear_opacity"), (Counts{10, 10, 10}));
  EXPECT_EQ(counts("trapezoid"), (Counts{11, 11, 10}));
  EXPECT_EQ(counts("simpson"), (Counts{11, 11, 5}));
  EXPECT_EQ(counts("sampled_virtual_catmull_rom_3"), (Counts{11, 40, 40}));
  EXPECT_EQ(counts("sampled_virtual_catmull_rom_7_recursion"), (Counts{11, 80, 80}));
  EXPECT_EQ(counts("order0_mid"), (Counts{21, 10, 10}));
  EXPECT_EQ(counts("order1"), (Counts{11, 10, 10}));
  // El Hajjar 2008, section 7: half the look-ups and composites at the same samples.
  EXPECT_EQ(counts("order2"), (Counts{11, 5, 5}));
  EXPECT_EQ(counts("order2_no_attenuation"), (Counts{11, 5, 5}));
  EXPECT_EQ(counts("order2_iterations_64"), (Counts{11, 5, 5}));
  EXPECT_EQ(counts("order3"), (Counts{11, 4, 4}));  // three triples and one interval
  EXPECT_EQ(counts("virtual_catmull_rom_3"), (Counts{11, 40, 40}));
  EXPECT_EQ(counts("cubic_split_none"), (Counts{11, 4, 4}));
  EXPECT_EQ(counts("cubic_split_middle"), (Counts{11, 8, 8}));
  EXPECT_EQ(counts("cell_adaptive"), (Counts{7, 2, 2}));
  EXPECT_EQ(counts("cell_cubic"), (Counts{16, 2, 2}));
}

TEST(EveryIntegralScheme, AccountsForItsError) {
  for (const Emission emission : both) {
    RayIntegral exact(random_transfer(3, 2), emission);
    SchemeIntegral integrate(random_transfer(3, 2), emission);
    for (std::uint64_t i = 0; i < 5; ++i) {
      const Chain<3> signal = noise_ray(i);
      const Certified truth = exact(signal);
      for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
        SCOPED_TRACE(scheme.name);
        const Samples<double> samples = at_step(signal, 0.5);
        const ErrorBudget budget = integrate.budget(scheme, signal, samples, truth);
        EXPECT_EQ(budget.round32.has_value(), family(scheme) == "sampled");
        const Difference round32 = budget.round32.value_or(Difference{});
        const double rest = budget.signal.opacity + budget.quadrature.opacity + round32.opacity - budget.total.opacity;
        EXPECT_LE(std::abs(rest), 1e-15);
        EXPECT_LE((budget.signal.color + budget.quadrature.color + round32.color - budget.total.color).abs().maxCoeff(),
                  2e-15);
        EXPECT_GE(budget.radius, truth.radius);
        if (is_exact(scheme)) {
          EXPECT_EQ(budget.quadrature.opacity, 0);
        }
        if (scheme.name == "cell_cubic") {
          EXPECT_LE(std::abs(budget.total.opacity), budget.radius);
        } else {
          EXPECT_GE(std::abs(budget.total.opacity) + budget.total.color.abs().maxCoeff(), 1e-5);
        }
      }
    }
  }
}

TEST(EveryIntegralScheme, RefusesSamplesThatItCannotUse) {
  const Chain<3> signal = noise_ray(0);
  Samples<double> samples;
  sample_cells(signal, samples);
  RayIntegral exact(smooth_transfer(), Emission::plain);
  SchemeIntegral integrate(smooth_transfer(), Emission::plain);
  for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
    SCOPED_TRACE(scheme.name);
    const bool needs_equal_steps =
        scheme.signal == "order3" || scheme.signal.starts_with("virtual") || scheme.signal.starts_with("cubic_split");
    EXPECT_EQ(integrate(scheme, signal, samples).refusal.empty(), !needs_equal_steps);
    EXPECT_EQ(integrate.budget(scheme, signal, samples, exact(signal)).outcome.refusal.empty(), !needs_equal_steps);
  }
  const Outcome<> not_cubic = integrate(*find_named(catalogue::integral_schemes(), "cell_cubic"), smooth_signal(),
                                        at_step(smooth_signal(), 0.5));
  EXPECT_FALSE(not_cubic.refusal.empty());
}

TEST(SampledSchemes, RoundAsTheirArithmeticDoes) {
  const Chain<9> smooth = smooth_signal();
  const Samples<double> samples = at_step(smooth, 0.125);
  for (const Emission emission : both) {
    const OpticsLookup<Real50> in_50_digits(smooth_transfer(), emission);
    const OpticsLookup<double> in_binary64(smooth_transfer(), emission);
    SchemeIntegral integrate(smooth_transfer(), emission);
    for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
      const auto* method = std::get_if<Sampled>(&scheme.method);
      if (method == nullptr) continue;
      SCOPED_TRACE(scheme.name);
      const Outcome<Real50> exact = march(*method, in_50_digits, SampledRay<Real50>(smooth, samples));
      const Outcome<double> outcome = march(*method, in_binary64, SampledRay<double>(smooth, samples));
      const Outcome<double> low = *integrate.in_binary32(scheme, smooth, samples);
      EXPECT_EQ(integrate(scheme, smooth, samples).opacity, outcome.opacity);
      // A slab is the work of some 20 operations, of relative error u each, on numbers whose sum over the ray is the
      // result, of order 1; `over` adds 2 u of the result for each slab. The square roots lose u of 1 for each slab.
      const bool is_recursive = method->correction == OpacityCorrection::recursion;
      const double ulps = 20 + 2.0 * static_cast<double>(outcome.composites) * (is_recursive ? 2 : 1);
      const auto error = [&](const auto& result) {
        double largest = std::abs(to_double(Real50(result.opacity) - exact.opacity));
        for (int i = 0; i < 3; ++i)
          largest = std::max(largest, std::abs(to_double(Real50(result.color[i]) - exact.color[i])));
        return largest;
      };
      EXPECT_LE(error(outcome), ulps * 0x1p-53);
      EXPECT_LE(error(low), ulps * 0x1p-24);
      EXPECT_GE(error(low), 0x1p-30);
    }
  }
}

TEST(SampledSchemes, KeepTheDigitsOfFaintRays) {
  const Chain<9> smooth = smooth_signal();
  const Samples<double> samples = at_step(smooth, 0.125);
  const OpticsLookup<Real50> in_50_digits(smooth_transfer(1e-12), Emission::associated);
  SchemeIntegral integrate(smooth_transfer(1e-12), Emission::associated);
  for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
    const auto* method = std::get_if<Sampled>(&scheme.method);
    if (method == nullptr) continue;
    SCOPED_TRACE(scheme.name);
    const double exact = to_double(march(*method, in_50_digits, SampledRay<Real50>(smooth, samples)).opacity);
    const double error = std::abs(integrate(scheme, smooth, samples).opacity / exact - 1);
    // Lee's recursion is the one that does not.
    if (method->correction == OpacityCorrection::recursion) {
      EXPECT_GE(error, 1e-6);
    } else {
      EXPECT_LE(error, 1e-14);
    }
  }
}

TEST(OpticsIntegral, IsExactWhereTheTransferFunctionIsLinear) {
  // tau c of a cubic signal is of degree 6: seven Gauss points integrate it exactly.
  const Piece<3> piece{0.0, 2.5, {{0.1, 1.3, -0.4, 0.8}}};
  const OpticsLookup<double> look_up(smooth_transfer(), Emission::associated);
  const auto integral = optics_integral({&piece, 1}, smooth_transfer(), Emission::associated);
  using Gauss = boost::math::quadrature::gauss<double, 7>;
  for (int i = 0; i < 4; ++i) {
    const auto optics = [&](double u) { return look_up(piece.polynomial.value(u))[i]; };
    EXPECT_NEAR(integral[i], 2.5 * Gauss::integrate(optics, 0.0, 1.0), 4e-15);
  }
}

TEST(OpticsIntegral, SplitsWhereTheTransferFunctionBends) {
  // Against the certified integral: its depth, and its colour where nothing absorbs.
  const PiecewiseLinear transfer = random_transfer(5, 1);
  std::vector<TransferPoint> clear = transfer.points();
  for (TransferPoint& point : clear) point.optics.extinction = 0;
  RayIntegral exact(transfer, Emission::plain);
  RayIntegral exact_clear(PiecewiseLinear(clear), Emission::plain);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Chain<3> signal = noise_ray(i);
    const auto integral = optics_integral(signal.pieces, transfer, Emission::plain);
    const Certified truth = exact(signal);
    const Certified color = exact_clear(signal);
    EXPECT_NEAR(-std::expm1(-integral[3]), truth.opacity, 4e-15 + truth.radius);
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(integral[channel], color.color[channel], 2e-14 + color.radius);
  }
}

TEST(IteratedSlab, ConvergesToTheIntegral) {
  const Chain<3> signal = noise_ray(0);
  const PiecewiseLinear transfer = random_transfer(5, 3);
  SchemeIntegral integrate(transfer, Emission::associated);
  const Samples<double> samples = at_step(signal, 0.5);
  const double ideal = integrate(*find_named(catalogue::integral_schemes(), "order2"), signal, samples).opacity;
  double before = 1;
  for (int count = 8; count <= 2048; count *= 8) {
    const auto* scheme = find_named(catalogue::integral_schemes(), "order2_iterations_" + std::to_string(count));
    const double error = std::abs(integrate(*scheme, signal, samples).opacity - ideal);
    EXPECT_LT(error, before);
    before = error / 8;
  }
}

TEST(CellAdaptive, SpendsItsBudgetWhereItIsWorthMost) {
  const std::vector<double> chords{0.3, 1.6, 0.9, 1.5, 0.01};
  const double mean = 4.31 / 5;
  const auto error = [&](const std::vector<int>& counts) {
    double sum = 0;
    for (std::size_t i = 0; i < chords.size(); ++i)
      sum += counts[i] == 0 ? std::pow(chords[i], 3) : counts[i] == 1 ? std::pow(chords[i], 4) / (24 * mean) : 0;
    return sum;
  };
  for (std::int64_t budget = 0; budget <= 20; ++budget) {
    const std::vector<int> chosen = inner_samples(chords, budget);
    std::int64_t taken = 6;
    for (const int count : chosen) taken += count;
    EXPECT_EQ(taken, std::clamp<std::int64_t>(budget, 6, 16));
    // No other choice of as many is better.
    std::vector<int> other(chords.size());
    for (int code = 0; code < 243; ++code) {
      int rest = code;
      std::int64_t spent = 6;
      for (int& count : other) {
        count = rest % 3;
        rest /= 3;
        spent += count;
      }
      if (spent <= taken) {
        EXPECT_GE(error(other), error(chosen) * (1 - 1e-15));
      }
    }
  }
}

/// A first sample of the short chord s, or a second one of the long chord 2: s^3 (1 - s / (24 m)) = 2^4 / (24 m), m =
/// (2 + s) / 2, at s = 0.787.
TEST(CellAdaptive, WeighsFirstSamplesAgainstSecondOnes) {
  EXPECT_EQ(inner_samples({2, 0.78}, 5), (std::vector{2, 0}));
  EXPECT_EQ(inner_samples({2, 0.795}, 5), (std::vector{1, 1}));
}

/// Its constant follows from the areas themselves: along rays in all directions through white noise, where what a line
/// misses of a cell is l/6 |p_2| and what a parabola does l/32 |p_3|, p_2 and p_3 the coefficients of u (u - 1) and
/// u (u - 1/2) (u - 1).
TEST(CellAdaptive, ItsConstantIsThatOfWhiteNoise) {
  double mean_chord = 0;
  double cubes = 0;
  double first = 0;
  double fourths = 0;
  double second = 0;
  std::size_t cells = 0;
  for (std::uint64_t i = 0; i < 400; ++i)
    for (const auto& piece : noise_ray(i).pieces) {
      const auto& b = piece.polynomial.coefficients;
      const double l = piece.length;
      const double cubic = b[3] - 3 * b[2] + 3 * b[1] - b[0];
      const double quadratic =
          4 * (piece.polynomial.value(0.0) / 2 + piece.polynomial.value(1.0) / 2 - piece.polynomial.value(0.5));
      first += std::abs(quadratic) * l / 6;
      second += std::abs(cubic) * l / 32;
      cubes += l * l * l;
      fourths += l * l * l * l;
      mean_chord += l;
      ++cells;
    }
  mean_chord /= static_cast<double>(cells);
  const double constant = (first / cubes) / (second / fourths) / mean_chord;
  EXPECT_NEAR(constant, 24, 4.8) << cells;  // 26 from many more rays
}

TEST(CellAdaptive, BeatsEveryOtherSignalAtEqualFetches) {
  // From 1.25 samples per cell, in white noise, on the mean over rays.
  std::map<std::string_view, double> sums;
  double adaptive = 0;
  Chain<3> approximation;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Chain<3> signal = noise_ray(i);
    const auto samples = at_step(signal, signal.length() / (1.25 * static_cast<double>(signal.pieces.size())));
    EXPECT_LE(approximate_cells(signal, static_cast<std::int64_t>(samples.values.size()), approximation),
              static_cast<std::int64_t>(samples.values.size()));
    adaptive += xi(signal, approximation);
    catalogue::for_each_scheme([&]<class S>() {
      approximate<S>(signal, samples, approximation);
      sums[S::info.name] += xi(signal, approximation);
    });
  }
  for (const auto& [name, sum] : sums) EXPECT_LT(adaptive, sum) << name;
}

TEST(CellAdaptive, IsExactFromThreeSamplesPerCellOn) {
  const Chain<3> signal = noise_ray(0);
  const auto cells = static_cast<std::int64_t>(signal.pieces.size());
  Chain<3> approximation;
  EXPECT_EQ(approximate_cells(signal, 1000, approximation), 3 * cells + 1);
  EXPECT_LE(xi_max(signal, approximation), 1e-14);
  EXPECT_EQ(approximate_cells(signal, 3 * cells, approximation), 3 * cells);
  EXPECT_GE(xi_max(signal, approximation), 1e-12);
  EXPECT_EQ(approximate_cells(signal, 2, approximation), cells + 1);
}

}  // namespace
}  // namespace raytruth
