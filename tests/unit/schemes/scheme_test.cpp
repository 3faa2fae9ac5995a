#include "raytruth/catalogue.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

// One loop over the catalogue for each property: a scheme is tested by being in it.

namespace raytruth {
namespace {

/// One smooth piece on [0, length]: a random polynomial of the given degree.
template <int Degree, class Real = Real50>
Chain<Degree, Real> smooth_signal(std::uint64_t seed, double length) {
  Chain<Degree, Real> chain;
  Bernstein<Degree, Real> p;
  for (std::size_t i = 0; i <= Degree; ++i)
    p.coefficients[i] = random_numbers(seed, RandomStream::points, i / 4)[i % 4];
  chain.pieces.push_back({0, length, p});
  chain.end = length;
  return chain;
}

template <class S, int Degree, class Real>
Real xi_at_step(const Chain<Degree, Real>& signal, const Real& step) {
  Samples<Real> samples;
  sample_constant(signal, step, samples);
  Chain<3, Real> approximation;
  approximate<S>(signal, samples, approximation);
  return xi(signal, approximation);
}

/// integral |d^order s / dt^order| dt of a single piece.
template <int Order, int Degree>
double variation(const Bernstein<Degree>& p, double length) {
  if constexpr (Order == 0)
    return p.integral_of_magnitude() * length;
  else
    return variation<Order - 1>(p.derivative(), length) / length;
}

template <class S>
Chain<3> approximation_of(const Chain<3>& signal, double step) {
  Samples<double> samples;
  sample_constant(signal, step, samples);
  Chain<3> approximation;
  approximate<S>(signal, samples, approximation);
  return approximation;
}

TEST(Catalogue, NamesAndStylesAreUnique) {
  std::set<std::string_view> names;
  std::set<std::pair<std::string_view, std::string_view>> styles;
  std::size_t count = 0;
  catalogue::for_each_scheme([&]<class S>() {
    names.insert(S::info.name);
    styles.emplace(S::info.color, S::info.marker);
    ++count;
    EXPECT_FALSE(S::info.summary.empty());
    EXPECT_FALSE(S::info.source.empty());
  });
  EXPECT_EQ(names.size(), count);
  EXPECT_EQ(styles.size(), count);
}

TEST(EveryScheme, ReproducesItsDegreeAndNotTheNext) {
  catalogue::for_each_scheme([]<class S>() {
    SCOPED_TRACE(S::info.name);
    const auto error = []<int Degree>(std::integral_constant<int, Degree>) {
      // 2.3 is no multiple of the step: the last interval is short.
      return xi_at_step<S>(smooth_signal<Degree>(11, 2.3), Real50(0.25));
    };
    const auto error_without_short_end = []<int Degree>(std::integral_constant<int, Degree>) {
      return xi_at_step<S>(smooth_signal<Degree>(11, 2), Real50(0.25));
    };
    constexpr int exact = S::info.exact_degree;
    EXPECT_LE(error_without_short_end(std::integral_constant<int, exact>{}), Real50("1e-40"));
    EXPECT_GE(error_without_short_end(std::integral_constant<int, exact + 1>{}), Real50("1e-6"));
    // A short or unpaired last interval is linear, in every scheme.
    if constexpr (exact <= 1) {
      EXPECT_LE(error(std::integral_constant<int, exact>{}), Real50("1e-40"));
    }
  });
}

TEST(EveryScheme, HasItsOrderAndItsErrorConstant) {
  catalogue::for_each_scheme([]<class S>() {
    SCOPED_TRACE(S::info.name);
    // In binary64: rounding moves xi by 3e-14 at most, a thousandth of the smallest one here.
    const auto signal = smooth_signal<9, double>(12, 2);
    double sum_x = 0;
    double sum_y = 0;
    double sum_xx = 0;
    double sum_yy = 0;
    double sum_xy = 0;
    double ratio = 0;
    int n = 0;
    // The ghost samples at the ends of virtual_catmull_rom add a share of about 15 h to its error: 0.04 in the slope.
    // With virtual samples the cubic's own error, of third order, shows until h is far below that of the lines.
    for (int k = 7; k <= 11; ++k, ++n) {
      const double step = std::ldexp(1, -k);
      const double error = xi_at_step<S>(signal, step);
      const double x = -k;
      const double y = std::log2(error);
      sum_x += x;
      sum_y += y;
      sum_xx += x * x;
      sum_yy += y * y;
      sum_xy += x * y;
      ratio = error / (S::info.error_constant * std::pow(step, S::info.order) *
                       variation<S::info.order>(signal.pieces[0].polynomial, 2));
    }
    const double covariance = n * sum_xy - sum_x * sum_y;
    const double slope = covariance / (n * sum_xx - sum_x * sum_x);
    const double correlation = covariance / std::sqrt((n * sum_xx - sum_x * sum_x) * (n * sum_yy - sum_y * sum_y));
    EXPECT_NEAR(slope, S::info.order, 0.05);
    EXPECT_GT(correlation, 0.9999);
    // Two-sided: a scheme that silently gets better fails as well.
    EXPECT_NEAR(ratio, 1, 0.01);
  });
}

TEST(EveryScheme, PassesThroughItsSamplesOrHoldsThem) {
  const Grid grid = random_field(16, 0, 1);
  const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 8.3, 1, 0));
  catalogue::for_each_scheme([&]<class S>() {
    SCOPED_TRACE(S::info.name);
    const Chain<3> approximation = approximation_of<S>(signal, 0.5);
    constexpr std::size_t parts = S::info.parts_per_interval;
    EXPECT_EQ(approximation.end, signal.end);
    if (S::info.exact_degree == 0) return;
    for (std::size_t i = 1; i < approximation.pieces.size(); ++i)
      EXPECT_EQ(approximation.pieces[i].polynomial.coefficients.front(),
                approximation.pieces[i - 1].polynomial.coefficients.back());
    if constexpr (GivesSlabs<S>) {
      // Five slabs of three intervals, one that is left over, and a short one: it passes through their ends.
      for (const double t : {0.0, 1.5, 3.0, 4.5, 6.0, 7.5, 8.0})
        EXPECT_EQ(approximation.pieces[approximation.index_at(t)].polynomial.coefficients.front(), signal.value(t));
      return;
    }
    ASSERT_EQ(approximation.pieces.size(), 17 * parts);
    for (std::size_t i = 0; i < approximation.pieces.size(); i += parts) {
      const auto& first = approximation.pieces[i];
      EXPECT_EQ(first.polynomial.coefficients.front(), signal.value(first.start));
      const auto& last = approximation.pieces[i + parts - 1];
      EXPECT_EQ(last.polynomial.coefficients.back(),
                signal.value(first.start + DoubleDouble(static_cast<double>(parts) * last.length)));
    }
  });
}

TEST(EveryScheme, HasNoErrorOnConstantsAndOnEmptyRays) {
  Chain<3> constant;
  constant.pieces = {{0.0, 1.5, {{0.1, 0.1, 0.1, 0.1}}}, {1.5, 2.25, {{0.1, 0.1, 0.1, 0.1}}}};
  constant.end = 3.75;
  catalogue::for_each_scheme([&]<class S>() {
    SCOPED_TRACE(S::info.name);
    const Chain<3> approximation = approximation_of<S>(constant, 0.3);
    EXPECT_LE(xi(constant, approximation), 1e-16);
    EXPECT_LE(xi_max(constant, approximation), 3e-17);
    EXPECT_TRUE(approximation_of<S>(Chain<3>{}, 0.3).pieces.empty());
    EXPECT_EQ(xi(Chain<3>{}, Chain<3>{}), 0);
  });
}

TEST(EveryScheme, ScalesWithUnitsBitByBit) {
  const Grid grid = random_field(16, 0, 1);
  catalogue::for_each_scheme([&]<class S>() {
    SCOPED_TRACE(S::info.name);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 8.3, 1, i));
      Chain<3> longer = signal;
      longer.end = {signal.end.high * 8, signal.end.low * 8};
      Chain<3> stronger = signal;
      for (std::size_t p = 0; p < signal.pieces.size(); ++p) {
        longer.pieces[p].start = {signal.pieces[p].start.high * 8, signal.pieces[p].start.low * 8};
        longer.pieces[p].length *= 8;
        for (double& b : stronger.pieces[p].polynomial.coefficients) b *= 0.25;
      }
      const double error = xi(signal, approximation_of<S>(signal, 0.5));
      EXPECT_EQ(xi(longer, approximation_of<S>(longer, 4)), 8 * error);
      EXPECT_EQ(xi(stronger, approximation_of<S>(stronger, 0.5)), 0.25 * error);
    }
  });
}

TEST(EveryScheme, CountsItsFetches) {
  Chain<3> signal;
  signal.pieces.push_back({0.0, 2.5, {{0, 1, 2, 3}}});
  signal.end = 2.5;
  catalogue::for_each_scheme([&]<class S>() {
    SCOPED_TRACE(S::info.name);
    Samples<double> samples;
    sample_constant(signal, 0.25, samples);
    EXPECT_EQ(samples.positions.size(), 11U);
    EXPECT_EQ(fetches<S>(samples), S::info.name == "order0_mid" ? 21 : 11);
  });
}

TEST(EveryScheme, TellsBinary32FromBinary64ByRounding) {
  // A rule's text in binary32 is within a few ulps of binary64.
  const auto close = [](const auto& b32, const auto& b64) {
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(to_double(b32[i]), b64[i], 16 * 0x1p-24);
  };
  Rules<Binary32> low;
  Rules<double> high;
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::array<double, 4> v = random_numbers(1, RandomStream::points, i);
    for (double& x : v) x = static_cast<double>(static_cast<float>(x));
    close(low.order0(v[0]), high.order0(v[0]));
    close(low.order1(v[0], v[1]), high.order1(v[0], v[1]));
    close(low.order2_front(v[0], v[1], v[2], 0.5), high.order2_front(v[0], v[1], v[2], 0.5));
    close(low.order2_back(v[0], v[1], v[2], 0.5), high.order2_back(v[0], v[1], v[2], 0.5));
    close(low.order3_front(v[0], v[1], v[2], v[3]), high.order3_front(v[0], v[1], v[2], v[3]));
    close(low.order3_middle(v[0], v[1], v[2], v[3]), high.order3_middle(v[0], v[1], v[2], v[3]));
    close(low.order3_back(v[0], v[1], v[2], v[3]), high.order3_back(v[0], v[1], v[2], v[3]));
    close(low.virtual_catmull_rom(v[0], v[1], v[2], v[3]), high.virtual_catmull_rom(v[0], v[1], v[2], v[3]));
    EXPECT_NEAR(to_double(low.virtual_sample({v[0], v[1], v[2], v[3]}, 0.375)),
                high.virtual_sample({v[0], v[1], v[2], v[3]}, 0.375), 16 * 0x1p-24);
  }
}

TEST(VirtualTexel, IsTheVirtualSampleOfEveryChannel) {
  Rules<double> rules;
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::array<Rules<double>::vec4, 4> texels;
    for (std::size_t k = 0; k < 4; ++k)
      for (Eigen::Index channel = 0; channel < 4; ++channel)
        texels[k][channel] = random_numbers(2, RandomStream::points, 4 * i + k)[static_cast<std::size_t>(channel)];
    const double u = random_numbers(3, RandomStream::points, i)[0];
    const auto [before, front, back, after] = texels;
    const auto found = rules.virtual_texel(before, front, back, after, u);
    for (Eigen::Index c = 0; c < 4; ++c)
      EXPECT_NEAR(found[c], rules.virtual_sample(rules.virtual_catmull_rom(before[c], front[c], back[c], after[c]), u),
                  8 * 0x1p-53);
    EXPECT_TRUE((rules.virtual_texel(before, front, back, after, 0) == front).all());
    EXPECT_TRUE((rules.virtual_texel(front, front, front, front, u) == front).all());
  }
}

TEST(Samples, ConstantStepsEndAtTheRaysEnd) {
  Chain<3> signal;
  signal.pieces.push_back({0.0, 1.1, {{0, 1, 2, 3}}});
  signal.end = 1.1;
  Samples<double> samples;
  sample_constant(signal, 0.1, samples);
  // 11 * 0.1 is 1.1 within 10^-9: no sliver at the end.
  ASSERT_EQ(samples.positions.size(), 12U);
  EXPECT_EQ(samples.positions[7], DoubleDouble(7 * 0.1));
  EXPECT_EQ(samples.positions.back(), DoubleDouble(1.1));
  sample_constant(signal, 5.0, samples);
  EXPECT_EQ(samples.positions.size(), 2U);
  EXPECT_THROW(sample_constant(signal, 1e-8, samples), InputError);
}

TEST(Samples, CellsAreBordersAndMidpoints) {
  Chain<3> signal;
  signal.pieces = {{0.0, 0.5, {{0, 0, 1, 1}}}, {0.5, 2, {{1, 2, 3, 4}}}};
  signal.end = 2.5;
  Samples<double> samples;
  sample_cells(signal, samples);
  const std::vector<DoubleDouble> positions{0.0, 0.25, 0.5, 1.5, 2.5};
  EXPECT_EQ(samples.positions, positions);
  EXPECT_EQ(samples.values, (std::vector<double>{0, 0.5, 1, 2.5, 4}));
}

TEST(Order2, LeavesTheRangeOfItsSamplesByAnEighth) {
  // Samples 0, 1, 1 at equal distances: the parabola reaches 9/8.
  const auto [low, high] = Rules<double>::cubic(Rules<double>{}.order2_back(0, 1, 1, 0.5)).range();
  EXPECT_EQ(low, 1);
  EXPECT_EQ(high, 1.125);
}

TEST(Order2, UnpairedIntervalIsLinear) {
  const Grid grid = random_field(16, 0, 1);
  const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 2.5, 1, 0));
  const Chain<3> second = approximation_of<Order2>(signal, 0.5);
  const Chain<3> first = approximation_of<Order1>(signal, 0.5);
  ASSERT_EQ(second.pieces.size(), 5U);
  EXPECT_NE(second.pieces[3].polynomial, first.pieces[3].polynomial);
  EXPECT_EQ(second.pieces[4].polynomial, first.pieces[4].polynomial);
}

TEST(VirtualCatmullRom, RefusesUnequalStepsAndKeepsAShortEndLinear) {
  const Grid grid = random_field(16, 0, 1);
  const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 2.3, 1, 0));
  Samples<double> samples;
  sample_cells(signal, samples);
  EXPECT_FALSE(refusal<VirtualCatmullRom>(samples).empty());
  EXPECT_TRUE(refusal<Order2>(samples).empty());
  const Chain<3> cubic = approximation_of<VirtualCatmullRom>(signal, 0.5);
  EXPECT_EQ(cubic.pieces.back().polynomial, approximation_of<Order1>(signal, 0.5).pieces.back().polynomial);
}

TEST(VirtualSamples, AreValuesOfTheCubicByLeesBlendingFunctions) {
  // Eq. 2 of Lee 2010 at 1/4, 1/2 and 3/4, in the inner intervals; at the ends the ghost sample continues a quadratic.
  const Grid grid = random_field(16, 0, 1);
  const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 5, 1, 0));
  Samples<double> samples;
  sample_constant(signal, 1.0, samples);
  std::vector<double> intensity = samples.values;
  ASSERT_EQ(intensity.size(), 6U);
  intensity.insert(intensity.begin(), 3 * intensity[0] - 3 * intensity[1] + intensity[2]);
  intensity.push_back(3 * intensity[6] - 3 * intensity[5] + intensity[4]);
  const Chain<3> approximation = approximation_of<VirtualCatmullRom3>(signal, 1);
  for (std::size_t k = 0; k < 5; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const double t = static_cast<double>(i) / 4;
      const double expected =
          intensity[k] * 0.5 * (-t * t * t + 2 * t * t - t) + intensity[k + 1] * 0.5 * (3 * t * t * t - 5 * t * t + 2) +
          intensity[k + 2] * 0.5 * (-3 * t * t * t + 4 * t * t + t) + intensity[k + 3] * 0.5 * (t * t * t - t * t);
      const auto& piece = approximation.pieces[4 * k + i];
      EXPECT_EQ(piece.start, DoubleDouble(static_cast<double>(k) + t));
      EXPECT_EQ(piece.length, 0.25);
      EXPECT_NEAR(piece.polynomial.coefficients[0], expected, 1e-15);
      // Linear in between.
      EXPECT_NEAR(piece.polynomial.value(0.5),
                  (piece.polynomial.coefficients[0] + piece.polynomial.coefficients[3]) / 2, 1e-16);
    }
}

TEST(VirtualSamples, OfTheChordAreOrder1) {
  const Grid grid = random_field(16, 0, 1);
  const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 5.3, 1, 0));
  const Chain<3> chord = approximation_of<Order1>(signal, 1);
  EXPECT_LE(xi_max(chord, approximation_of<VirtualLinear1>(signal, 1)), 4e-16);
  EXPECT_LE(xi_max(chord, approximation_of<VirtualLinear3>(signal, 1)), 4e-16);
  EXPECT_LE(xi_max(chord, approximation_of<VirtualLinear7>(signal, 1)), 4e-16);
}

TEST(EveryScheme, RefusesUnequalStepsWhereItNeedsEqualOnes) {
  const Grid grid = random_field(16, 0, 1);
  Samples<double> samples;
  sample_cells(trace_trilinear(grid, random_ray(grid, 2.3, 1, 0)), samples);
  catalogue::for_each_scheme([&]<class S>() {
    SCOPED_TRACE(S::info.name);
    const bool needs_equal_steps =
        S::info.name.starts_with("virtual") || S::info.name.starts_with("cubic_split") || S::info.name == "order3";
    EXPECT_EQ(refusal<S>(samples).empty(), !needs_equal_steps);
  });
}

TEST(Order3, ReproducesTrilinearRaysFromThreeFetchesPerCell) {
  const Grid grid = random_field(16, 0, 1);
  const Chain<3> signal = trace_trilinear(grid, random_ray(grid, 8.3, 1, 0));
  Samples<double> samples;
  sample_cells(signal, samples, 3);
  ASSERT_TRUE(refusal<Order3>(samples).empty());
  EXPECT_EQ(fetches<Order3>(samples), static_cast<std::int64_t>(3 * signal.pieces.size() + 1));
  Chain<3> approximation;
  approximate<Order3>(signal, samples, approximation);
  EXPECT_LE(xi_max(signal, approximation), 1e-14);
  // A constant step that crosses the cells' borders meets their kinks.
  EXPECT_GE(xi_max(signal, approximation_of<Order3>(signal, 0.25)), 1e-3);
}

TEST(Order3, LeftOverIntervalsLieOnTheLastCubicAndAShortOneIsLinear) {
  const auto signal = smooth_signal<3, double>(7, 2.1);
  const Chain<3> approximation = approximation_of<Order3>(signal, 0.25);
  ASSERT_EQ(approximation.pieces.size(), 9U);
  Samples<double> samples;
  sample_constant(signal, 0.25, samples);
  const Chain<3> line = approximation_of<Order1>(signal, 0.25);
  EXPECT_EQ(approximation.pieces[8].polynomial, line.pieces[8].polynomial);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(approximation.pieces[k].polynomial.value(0.3), signal.value(approximation.pieces[k].start + 0.075),
                1e-15);
  EXPECT_EQ(slab_intervals<Order3>(samples, 0), 3U);
  EXPECT_EQ(slab_intervals<Order3>(samples, 6), 1U);
}

TEST(VirtualSamples, CountAsSamplesWhereThereAreTooMany) {
  Samples<double> samples{.positions = std::vector<DoubleDouble>(1'250'001), .values = {}, .step = 1};
  EXPECT_TRUE(refusal<VirtualCatmullRom7>(samples).empty());
  samples.positions.emplace_back();
  EXPECT_FALSE(refusal<VirtualCatmullRom7>(samples).empty());
  EXPECT_TRUE(refusal<VirtualCatmullRom3>(samples).empty());
}

}  // namespace
}  // namespace raytruth
