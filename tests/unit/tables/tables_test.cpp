#include "raytruth/catalogue.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/dissertation_linear.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/exponential_moments.hpp"
#include "raytruth/tables/moments.hpp"
#include "raytruth/tables/no_attenuation.hpp"
#include "raytruth/tables/subrange.hpp"
#include "raytruth/tables/weighted.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cfenv>
#include <cmath>
#include <functional>
#include <tuple>
#include <vector>

namespace raytruth {
namespace {

constexpr std::array both_emissions{Emission::associated, Emission::plain};

/// Every composite of 10^3 slabs rounds by 2^-53; their errors add up like a random walk and are damped.
constexpr double rounding = 1e-14;

double uniform(std::uint64_t index) { return random_numbers(7, RandomStream::transfers, index)[0]; }

/// Opacities in [0, 1], every fifth 0 and every seventh 1.
DiscreteTransfer random_opacities(std::size_t size) {
  std::vector<OpacityEntry> entries;
  for (std::uint64_t i = 0; i < size; ++i) {
    const double opacity = i % 5 == 0 ? 0 : i % 7 == 0 ? 1 : uniform(4 * i);
    entries.push_back({opacity, {uniform(4 * i + 1), uniform(4 * i + 2), uniform(4 * i + 3)}});
  }
  return from_opacities(entries);
}

template <class Real>
double largest_difference(const Table<Real>& a, const Table<double>& b) {
  double result = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double difference = std::abs(static_cast<double>(a.values[i]) - b.values[i]);
    if (!(difference <= result)) result = difference;
  }
  return result;
}

PiecewiseLinear homogeneous(double extinction) { return PiecewiseLinear({{0.5, {extinction, {1, 0.5, 0.25}}}}); }

/// Integral of f over [a, b] by 30 nodes of Gauss: exact to rounding for what is smooth there.
double integral(const std::function<double(double)>& f, double a, double b) {
  return boost::math::quadrature::gauss<double, 30>::integrate(f, a, b);
}

TEST(Subranges, AreTheProductsOfNeighbours) {
  // Words: concatenation is associative and does not commute.
  for (std::size_t count = 1; count < 20; ++count) {
    std::vector<std::string> letters;
    for (std::size_t i = 0; i < count; ++i) letters.emplace_back(1, static_cast<char>('a' + i));
    for (std::size_t width = 1; width <= count; ++width) {
      std::size_t next = 0;
      for_each_subrange(
          letters, width, [](const auto& a, const auto& b) { return a + b; },
          [&](std::size_t first, const std::string& word) {
            EXPECT_EQ(first, next++);
            EXPECT_EQ(word, std::string("abcdefghijklmnopqrst").substr(first, width));
          });
      EXPECT_EQ(next, count - width + 1);
    }
  }
}

TEST(SubrangeTable, IsTheBruteForceTable) {
  for (const std::size_t size : {2U, 3U, 4U, 5U, 8U, 17U, 64U, 101U})
    for (const double length : {0.01, 1.0, 30.0}) {
      const TableAxes axes{.size = size, .length = length};
      for (const Emission emission : both_emissions) {
        DiscreteTransfer transfer = random_opacities(size);
        transfer.emission = emission;
        EXPECT_LE(largest_difference(subrange_table<double>(transfer, axes), brute_force_table<double>(transfer, axes)),
                  rounding * std::max(1.0, length));
      }
    }
}

TEST(BruteForceTable, IsEquation1) {
  const std::vector<OpacityEntry> entries{{0.25, {1, 0, 0}}, {0.75, {0, 1, 0}}, {0.5, {0, 0, 1}}};
  const auto table = brute_force_table<double>(from_opacities(entries), {.size = 3, .length = 3});
  const double front = 1 - std::pow(0.75, 1.5);
  const double back = 1 - std::pow(0.25, 1.5);
  EXPECT_NEAR(table.at(0, 2)[0], front, 1e-15);
  EXPECT_NEAR(table.at(0, 2)[1], (1 - front) * back, 1e-15);
  EXPECT_NEAR(table.at(0, 2)[3], 1 - (1 - front) * (1 - back), 1e-15);
  EXPECT_NEAR(table.at(2, 0)[0], (1 - back) * front, 1e-15);
  EXPECT_NEAR(table.at(2, 0)[1], back, 1e-15);
  EXPECT_NEAR(table.at(1, 2)[1], 1 - std::pow(0.25, 3), 1e-15);
  EXPECT_NEAR(table.at(2, 2)[2], 1 - std::pow(0.5, 3), 1e-15);  // the limit for i = j
}

TEST(SubrangeTable, MeetsNoLogarithmOfZeroAndNoDivision) {
  std::feclearexcept(FE_ALL_EXCEPT);
  const auto table = subrange_table<double>(random_opacities(64), {.size = 64});
  EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO | FE_INVALID), 0);
  EXPECT_EQ(table.at(7, 7)[3], 1);
  EXPECT_EQ(table.at(5, 5)[3], 0);
  EXPECT_EQ(table.at(3, 30)[3], 1);  // across opaque entries
}

TEST(SubrangeTable, CountedInclusivelyIsTooLongByOneEntry) {
  constexpr double extinction = 0.7;
  const auto table =
      inclusive_subrange_table(sampled(homogeneous(extinction), {.size = 9}, Emission::associated), {.size = 9});
  for (std::size_t back = 0; back < 9; ++back)
    for (std::size_t front = 0; front < 9; ++front) {
      const double width = std::abs(static_cast<double>(back) - static_cast<double>(front));
      const double entries = width == 0 ? 1 : (width + 1) / width;
      EXPECT_NEAR(table.at(front, back)[3], -std::expm1(-extinction * entries), 1e-15);
    }
  // From i to j, both included, in the order of crossing.
  const DiscreteTransfer transfer = random_opacities(9);
  const auto random = inclusive_subrange_table(transfer, {.size = 9});
  for (const auto& [front, back] : {std::pair{1, 4}, {4, 1}, {8, 2}, {0, 8}}) {
    const int step = front < back ? 1 : -1;
    auto slab = Table<double>::Texel::Constant(0).eval();
    for (int k = front; k != back + step; k += step)
      slab =
          Rules<double>{}.over(slab, homogeneous_stretch<double>(transfer.entries[static_cast<std::size_t>(k)],
                                                                 Emission::associated, 1.0 / std::abs(back - front)));
    EXPECT_LE((random.at(static_cast<std::size_t>(front), static_cast<std::size_t>(back)) - slab).abs().maxCoeff(),
              rounding);
  }
}

TEST(DiscreteTransfer, HoldsTheMeansOfItsIntervals) {
  // tau = 2 s, c = s: mean extinction s_k + s_(k+1), mean of tau c over it 2/3 (a^2 + a b + b^2) / (a + b).
  const PiecewiseLinear ramp({{0, {0, {0, 0, 0}}}, {1, {2, {1, 1, 1}}}});
  const auto means = interval_means(ramp, {.size = 5}, Emission::associated);
  for (std::size_t k = 0; k < 4; ++k) {
    const double a = static_cast<double>(k) / 4;
    const double b = a + 0.25;
    EXPECT_NEAR(means.intervals[k].extinction, a + b, 1e-15);
    EXPECT_NEAR(means.intervals[k].color[0], 2.0 / 3 * (a * a + a * b + b * b) / (a + b), 1e-15);
  }
}

TEST(DiscreteTransfer, RefusesWhatIsNoTransferFunction) {
  EXPECT_THROW(from_opacities({{0.5, {1, 1, 1}}}), InputError);
  EXPECT_THROW(from_opacities({{0.5, {1, 1, 1}}, {1.5, {1, 1, 1}}}), InputError);
  EXPECT_THROW(from_opacities({{0.5, {1, 1, 1}}, {NAN, {1, 1, 1}}}), InputError);
  EXPECT_THROW(from_opacities({{0.5, {1, 1, 1}}, {0.5, {1, -1, 1}}}), InputError);
}

TEST(TableAxes, RefusesWhatIsNoTable) {
  for (const TableAxes& axes : {TableAxes{.size = 1},
                                {.size = 20000},
                                {.size = 4, .low = 1},
                                {.size = 4, .length = 0},
                                {.size = 4, .high = INFINITY},
                                {.size = 4, .length = NAN}})
    EXPECT_THROW(exact_table(ramp_transfer(1), axes, Emission::associated), InputError);
}

TEST(Tables, HaveOneValueEverywhereIfTheTransferFunctionHas) {
  for (const Emission emission : both_emissions)
    for (const double extinction : {0.0, 1e-9, 0.5, 20.0}) {
      const PiecewiseLinear transfer = homogeneous(extinction);
      const TableAxes axes{.size = 33, .length = 1.5};
      const DiscreteTransfer means = interval_means(transfer, axes, emission);
      const auto moments = moment_tables(means, axes);
      const auto& [m0, m1, m2, m3] = moments.moments;
      for (const auto& table : {brute_force_table<double>(sampled(transfer, axes, emission), axes),
                                subrange_table<double>(means, axes), exact_table(transfer, axes, emission),
                                no_attenuation_table(transfer, axes, emission), m0, m1, m2, m3, moments.tent}) {
        const auto texel = table.at(0, 0);
        for (std::size_t back = 0; back < axes.size; ++back)
          for (std::size_t front = 0; front < axes.size; ++front)
            EXPECT_LE((table.at(front, back) - texel).abs().maxCoeff(), 1e-14 * std::max(1.0, texel.maxCoeff()));
      }
    }
}

TEST(ExactTable, HasTheClosedFormsOfARamp) {
  // tau = m s, c = (s, 1/2, 1 - s): depth m (a + b) / 2, second channel half the opacity, first and third add up to it.
  for (const double m : {0.01, 1.0, 30.0}) {
    const TableAxes axes{.size = 48};
    const auto table = exact_table(ramp_transfer(m), axes, Emission::associated);
    for (std::size_t back = 0; back < axes.size; ++back)
      for (std::size_t front = 0; front < axes.size; ++front) {
        const auto texel = table.at(front, back);
        const double opacity = -std::expm1(-m * (axes.scalar(front) + axes.scalar(back)) / 2);
        EXPECT_NEAR(texel[3], opacity, 1e-15 + rounding * opacity);
        EXPECT_NEAR(texel[1], opacity / 2, 1e-15 + rounding * opacity);
        EXPECT_NEAR(texel[0] + texel[2], opacity, 1e-15 + rounding * opacity);
      }
  }
}

TEST(ExactTable, RefusesWhatIsTooDeepToTell) {
  const TableAxes deep{.size = 3, .length = largest_exact_depth};
  EXPECT_NO_THROW(exact_table(ramp_transfer(1), deep, Emission::associated));
  EXPECT_THROW(exact_table(ramp_transfer(1.001), deep, Emission::associated), InputError);
}

TEST(ExactTable, IsCertifiedEntryByEntry) {
  // 7 transfer functions, 2 emissions, 2 extinctions, 358 entries of each: more than 10^4.
  constexpr std::size_t entries = 358;
  constexpr TableAxes axes{.size = 97, .length = 1};
  std::uint64_t index = 0;
  for (const catalogue::TransferEntry& shape : catalogue::transfers) {
    if (shape.make == nullptr) continue;
    for (const Emission emission : both_emissions)
      for (const double extinction : {2.0, 50.0}) {
        const PiecewiseLinear transfer = shape.make(extinction, 1);
        const auto table = exact_table(transfer, axes, emission);
        RayIntegral reference(transfer, emission);
        for (std::size_t k = 0; k < entries + 60; ++k) {
          const auto draw = [&] { return static_cast<std::size_t>(uniform(1000 + index++) * axes.size); };
          const std::size_t front = draw();
          const std::size_t back = k % 6 == 0 ? front : draw();
          const Bernstein<1> signal{{axes.scalar(front), axes.scalar(back)}};
          const auto truth = reference(Chain<3>{{{0.0, axes.length, signal.elevated<3>()}}, axes.length});
          const auto texel = table.at(front, back);
          // Scalars are rounded on both sides: 2^-53 of them, times slopes of up to 500 per unit.
          const double allowed = truth.radius + 3e-14;
          for (int channel = 0; channel < 3; ++channel)
            ASSERT_NEAR(texel[channel], truth.color[channel], allowed) << shape.name << ' ' << front << ' ' << back;
          ASSERT_NEAR(texel[3], truth.opacity, allowed) << shape.name << ' ' << front << ' ' << back;
        }
      }
  }
  EXPECT_GE(index, 10000U);
}

TEST(NoAttenuationTable, IsTheLimitOfThinSlabs) {
  // Its error is second order in the depth, that of the exact table none.
  constexpr TableAxes axes{.size = 17};
  std::vector<double> differences;
  for (const double extinction : {1e-3, 1e-4}) {
    const PiecewiseLinear transfer = tent_transfer(extinction);
    differences.push_back(largest_difference(no_attenuation_table(transfer, axes, Emission::associated),
                                             exact_table(transfer, axes, Emission::associated)));
  }
  EXPECT_NEAR(differences[0] / differences[1], 100, 1);
}

TEST(WeightedTables, SumToTheWholeAndAreSymmetric) {
  constexpr TableAxes axes{.size = 65};
  const DiscreteTransfer transfer = random_opacities(axes.size);
  const auto tables = weighted_tables<double>(transfer, axes);
  const auto whole = subrange_table<double>(transfer, axes);
  DiscreteTransfer mirrored = transfer;
  std::reverse(mirrored.entries.begin(), mirrored.entries.end());
  std::reverse(mirrored.intervals.begin(), mirrored.intervals.end());
  const auto mirror_image = weighted_tables<double>(mirrored, axes);
  for (std::size_t back = 0; back < axes.size; ++back)
    for (std::size_t front = 0; front < axes.size; ++front) {
      const auto to_front = tables.front.at(front, back);
      const auto to_back = tables.back.at(front, back);
      EXPECT_LE((to_front + to_back - whole.at(front, back)).head<3>().abs().maxCoeff(), rounding);
      EXPECT_EQ(to_front[3], to_back[3]);
      EXPECT_LE((mirror_image.back.at(axes.size - 1 - front, axes.size - 1 - back) - to_back).abs().maxCoeff(),
                rounding);
    }
}

/// The weighted colour towards the back, added up as it is defined.
template <class Real>
Real weighted_directly(const DiscreteTransfer& transfer, const TableAxes& axes, std::size_t front, std::size_t back) {
  const std::size_t width = front < back ? back - front : front - back;
  Real transmittance(1);
  Real sum(0);
  for (std::size_t k = 0; k < width; ++k) {
    const auto slab =
        homogeneous_stretch<Real>(transfer.intervals[front < back ? front + k : front - 1 - k], transfer.emission,
                                  Real(axes.length) / Real(static_cast<double>(width)));
    sum = sum + transmittance * slab[0] * Real(static_cast<double>(k) + 0.5) / Real(static_cast<double>(width));
    transmittance = transmittance * (Real(1) - slab[3]);
  }
  return sum;
}

TEST(WeightedTables, AreTheirDefinition) {
  constexpr TableAxes axes{.size = 41};
  double of_stable = 0;
  double of_printed = 0;
  for (const Emission emission : both_emissions) {
    const DiscreteTransfer transfer = interval_means(random_transfer(3, 1), axes, emission);
    const auto stable = weighted_tables<double>(transfer, axes);
    const auto printed = weighted_tables_by_difference<double>(transfer, axes);
    for (std::size_t back = 0; back < axes.size; ++back)
      for (std::size_t front = 0; front < axes.size; ++front) {
        if (front == back) continue;
        const auto exact = static_cast<double>(weighted_directly<Real50>(transfer, axes, front, back));
        of_stable = std::max(of_stable, std::abs(stable.back.at(front, back)[0] - exact));
        of_printed = std::max({of_printed, std::abs(printed.back.at(front, back)[0] - exact),
                               std::abs(printed.front.at(front, back)[0] - stable.front.at(front, back)[0])});
      }
  }
  EXPECT_LE(of_stable, 1e-15);
  EXPECT_LE(of_printed, 2e-14);  // i C^1 and C^G are up to 40 times as large as what is left of them
}

TEST(WeightedTables, SpecularOnesAreWhite) {
  constexpr TableAxes axes{.size = 16};
  const auto tables =
      weighted_tables<double>(whitened(interval_means(tent_transfer(5), axes, Emission::associated)), axes);
  for (std::size_t back = 0; back < axes.size; ++back)
    for (std::size_t front = 0; front < axes.size; ++front) {
      const auto sum = (tables.front.at(front, back) + tables.back.at(front, back)).eval();
      EXPECT_NEAR(sum[0], sum[3] / 2, rounding);  // white light in the associated convention is the opacity
      EXPECT_EQ(sum[0], sum[2]);
    }
}

TEST(ExponentialMoments, AreTheIntegrals) {
  // In 50 digits upwards, y J_k = k J_(k-1) - e^-y, which then has digits to lose.
  for (double y = 0x1p-10; y <= 32; y *= 1.0625) {
    Real50 exact = (1 - exp(-Real50(y))) / y;
    for (std::size_t k = 0; k < 4; ++k) {
      if (k > 0) exact = (static_cast<double>(k) * exact - exp(-Real50(y))) / y;
      EXPECT_LE(to_double(abs(Real50(exponential_moments(y)[k] / exact - 1))), 1e-15) << y << ' ' << k;
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_DOUBLE_EQ(exponential_moments(0)[k], 1 / (static_cast<double>(k) + 1));
    EXPECT_DOUBLE_EQ(exponential_moments(1e-9)[k],
                     1 / (static_cast<double>(k) + 1) - 1e-9 / (static_cast<double>(k) + 2));
  }
  EXPECT_NEAR(exponential_moments(1e6)[3], 6e-24, 1e-38);
}

TEST(MomentTables, AreTheirDefinition) {
  // Interval by interval, by quadrature.
  constexpr TableAxes axes{.size = 20, .length = 2};
  for (const Emission emission : both_emissions) {
    const DiscreteTransfer transfer = interval_means(random_transfer(3, 2), axes, emission);
    const auto tables = moment_tables(transfer, axes);
    for (std::size_t back = 0; back < axes.size; ++back)
      for (std::size_t front = 0; front < axes.size; ++front) {
        const std::size_t width = front == back ? 1 : front < back ? back - front : front - back;
        const double length = axes.length / static_cast<double>(width);
        const auto interval = [&](std::size_t k) -> const Optics& {
          return front == back  ? transfer.entries[front]
                 : front < back ? transfer.intervals[front + k]
                                : transfer.intervals[front - 1 - k];
        };
        const auto weighted = [&](const std::function<double(double)>& weight, bool is_white) {
          double sum = 0;
          double depth = 0;
          for (std::size_t k = 0; k < width; ++k) {
            const auto& [extinction, color] = interval(k);
            const double density =
                (emission == Emission::associated ? extinction : 1) * (is_white ? 1 : color[1]) * length;
            const auto light = [&, k, extinction = extinction](double v) {
              return weight((static_cast<double>(k) + v) / static_cast<double>(width)) * density *
                     std::exp(-depth - extinction * length * v);
            };
            sum += integral(light, 0, 0.5) + integral(light, 0.5, 1);  // the middle of the slab is an end of one
            depth += extinction * length;
          }
          return sum;
        };
        for (std::size_t k = 0; k < 4; ++k) {
          const auto power = [k](double s) { return std::pow(s, static_cast<double>(k)); };
          EXPECT_NEAR(tables.moments[k].at(front, back)[1], weighted(power, false), 2 * rounding);
          EXPECT_NEAR(tables.moments[k].at(front, back)[3], weighted(power, true), 2 * rounding);
        }
        EXPECT_NEAR(tables.tent.at(front, back)[0],
                    weighted([](double s) { return s < 0.5 ? 2 * s : 2 - 2 * s; }, true), 2 * rounding);
      }
    const auto whole = subrange_table<double>(transfer, axes);
    for (std::size_t i = 0; i < axes.size; ++i) {
      EXPECT_NEAR(tables.tent.at(i, 3)[3], whole.at(i, 3)[3], rounding);
      EXPECT_NEAR(tables.moments[0].at(i, 3)[0], whole.at(i, 3)[0], rounding);
    }
  }
}

TEST(MomentTables, TakeOpaqueEntries) {
  const auto tables = moment_tables(random_opacities(30), {.size = 30});
  for (const Table<double>& table : tables.moments)
    for (const double value : table.values) EXPECT_TRUE(value >= 0 && value <= 1 + rounding);
}

TEST(DissertationTable, CorrectedIsExactAtItsDistances) {
  constexpr TableAxes axes{.size = 33};
  for (const Emission emission : both_emissions) {
    const PiecewiseLinear transfer = random_transfer(5, 3);
    const auto exact = exact_table(transfer, axes, emission);
    for (const auto interpolation : {DistanceInterpolation::opacity, DistanceInterpolation::logarithm}) {
      const auto table =
          dissertation_linear_table(transfer, axes, emission, DissertationAlgorithm::corrected, interpolation);
      for (std::size_t back = 0; back < axes.size; ++back)
        for (std::size_t front = 0; front < axes.size; ++front) {
          const auto error = (table.at(front, back) - exact.at(front, back)).abs().eval();
          const std::size_t width = front < back ? back - front : front - back;
          const bool is_power_of_2 = (width & (width - 1)) == 0;
          if (is_power_of_2) {
            EXPECT_LE(error.maxCoeff(), rounding);
          }
          if (interpolation == DistanceInterpolation::logarithm) {
            EXPECT_LE(error[3], rounding);
          } else if (!is_power_of_2) {
            EXPECT_GT(error[3], 1e-5);
          }
        }
    }
  }
}

TEST(DissertationTable, IsAsPrinted) {
  // Entries at 0, 1/2 and 1 with tau = 2 s and plain light 1, distance 1 = d_1 (d_0 = 1/2): A = 0, 1/4, 1 half units.
  const PiecewiseLinear ramp({{0, {0, {1, 1, 1}}}, {1, {2, {1, 1, 1}}}});
  constexpr TableAxes axes{.size = 3};
  const auto of = [&](DissertationAlgorithm algorithm) {
    return dissertation_linear_table(ramp, axes, Emission::plain, algorithm, DistanceInterpolation::opacity).at(0, 2);
  };
  // Means of tau 1/2 and 3/2 in the intervals; color_1d of distance d at entries 1 and 2, by the trapezoid rule.
  const auto b_1 = [](double d) { return d * (1 + std::exp(-d * 0.5)) / 2; };
  const auto b_2 = [](double d) { return d * (std::exp(-d * 0.5) + std::exp(-d * 2 / 2)) / 2; };
  const double start = 1;  // C_1 of slabs from 0 to 0
  const double before = start * std::exp(-0.5) + b_1(1);
  EXPECT_NEAR(of(DissertationAlgorithm::pseudo_code)[0], before * std::exp(-1.5) + b_2(1), 1e-15);
  const double before_at_half = 0 * std::exp(-0.25) + b_1(0.5);  // there is no distance below the first
  EXPECT_NEAR(of(DissertationAlgorithm::text)[0], before_at_half * std::exp(-1.5) + b_2(1), 1e-15);
  EXPECT_NEAR(of(DissertationAlgorithm::text)[3], -std::expm1(-1), 1e-15);
}

/// Counts what a table's builder does: differences, of which a composite takes one, and exponentials.
struct Counted {
  double value = 0;
  static inline std::atomic<std::int64_t> differences = 0;
  static inline std::atomic<std::int64_t> exponentials = 0;

  Counted() = default;
  Counted(double x) : value(x) {}  // NOLINT(google-explicit-constructor)

  friend Counted operator+(Counted a, Counted b) { return a.value + b.value; }
  friend Counted operator-(Counted a, Counted b) { return ++differences, a.value - b.value; }
  friend Counted operator*(Counted a, Counted b) { return a.value * b.value; }
  friend Counted operator/(Counted a, Counted b) { return a.value / b.value; }
  friend Counted operator-(Counted a) { return -a.value; }
  friend auto operator<=>(Counted a, Counted b) { return a.value <=> b.value; }
  friend Counted expm1(Counted x) { return ++exponentials, std::expm1(x.value); }
};

template <class Build>
TableCost counted(const Build& build) {
  Counted::differences = Counted::exponentials = 0;
  build();
  return {.composites = Counted::differences, .exponentials = Counted::exponentials};
}

TEST(TableCost, IsWhatIsCounted) {
  for (const std::size_t size : {2U, 3U, 7U, 16U, 33U}) {
    const TableAxes axes{.size = size};
    const DiscreteTransfer transfer = random_opacities(size);
    const auto count = static_cast<std::int64_t>(size);
    const TableCost brute = counted([&] { brute_force_table<Counted>(transfer, axes); });
    EXPECT_EQ(brute.composites, brute_force_cost(count).composites);
    EXPECT_EQ(brute.exponentials, brute_force_cost(count).exponentials);
    const TableCost subrange = counted([&] { subrange_table<Counted>(transfer, axes); });
    EXPECT_EQ(subrange.composites, subrange_cost(count).composites);
    EXPECT_EQ(subrange.exponentials, subrange_cost(count).exponentials);
  }
}

}  // namespace
}  // namespace raytruth
