#include "raytruth/schemes/cubic_split.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/metrics/signal_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace raytruth {
namespace {

constexpr std::array every_split{CubicSplit::none, CubicSplit::inflection, CubicSplit::extrema, CubicSplit::middle,
                                 CubicSplit::fewest};
constexpr double tolerance = 1e-3;

template <int Degree, class Real = double>
Bernstein<Degree, Real> random_polynomial(std::uint64_t index) {
  Bernstein<Degree, Real> p;
  for (std::size_t i = 0; i <= Degree; ++i)
    p.coefficients[i] = random_numbers(5, RandomStream::points, 4 * index + i / 4)[i % 4];
  return p;
}

template <int Degree, class Real>
std::vector<Real> borders_of(const Bernstein<Degree, Real>& p, CubicSplit split, double error = tolerance) {
  std::vector<Real> borders;
  split_borders(p, split, Real(error), borders);
  return borders;
}

template <int Degree, class Real>
Chain<3, Real> parabolas(const Bernstein<Degree, Real>& p, double length, const std::vector<Real>& borders) {
  Chain<3, Real> chain;
  append_parts(Piece<Degree, Real>{{}, Real(length), p}, borders, chain);
  chain.end = Abscissa<Real>(Real(length));
  return chain;
}

template <int Degree, class Real>
Chain<Degree, Real> one_piece(const Bernstein<Degree, Real>& p, double length) {
  Chain<Degree, Real> chain;
  chain.pieces.push_back({{}, Real(length), p});
  chain.end = Abscissa<Real>(Real(length));
  return chain;
}

/// The area by a sum of many midpoints, the parabola written down by Lagrange.
double brute_force_xi(const Bernstein<3>& p, double length, const std::vector<double>& borders) {
  constexpr int steps = 4000;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const double width = borders[i + 1] - borders[i];
    const double front = p.value(borders[i]);
    const double middle = p.value(borders[i] + width / 2);
    const double back = p.value(borders[i + 1]);
    for (int k = 0; k < steps; ++k) {
      const double v = (k + 0.5) / steps;
      const double parabola = front * (2 * v - 1) * (v - 1) + middle * 4 * v * (1 - v) + back * v * (2 * v - 1);
      sum += std::abs(p.value(borders[i] + v * width) - parabola) * width * length / steps;
    }
  }
  return sum;
}

/// abs(a_3) sum of part^4 / 32, a_3 in lengths.
double area_of(const Bernstein<3>& p, double length, const std::vector<double>& borders) {
  const auto& b = p.coefficients;
  const double leading = std::abs(b[3] - 3 * b[2] + 3 * b[1] - b[0]) / std::pow(length, 3);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) sum += std::pow((borders[i + 1] - borders[i]) * length, 4);
  return leading * sum / 32;
}

TEST(CubicSplit, ErrorIsTheThirdCoefficientTimesTheFourthPowersOfTheParts) {
  constexpr double length = 1.7;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto p = random_polynomial<3>(i);
    for (const CubicSplit split : every_split) {
      const auto borders = borders_of(p, split);
      const double expected = area_of(p, length, borders);
      const double found = xi(one_piece(p, length), parabolas(p, length, borders));
      EXPECT_NEAR(found, expected, 1e-14);
      EXPECT_NEAR(brute_force_xi(p, length, borders), expected, 1e-6 * expected + 1e-15);
      if (split == CubicSplit::none) {
        EXPECT_NEAR(mean_split_error(p, 1) * length, expected, 1e-15);
      }
    }
  }
}

TEST(CubicSplit, PlacesAreWhereTheDerivativesChangeSign) {
  int inflections = 0;
  int extrema = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto p = random_polynomial<3, Real50>(i);
    const auto check = [](const auto& borders, const auto& changes) {
      ASSERT_EQ(borders.size(), changes.size() + 2);
      for (std::size_t k = 0; k < changes.size(); ++k) EXPECT_LT(abs(borders[k + 1] - changes[k]), Real50("1e-40"));
    };
    const auto bends = p.derivative().derivative().sign_changes();
    const auto turns = p.derivative().sign_changes();
    check(borders_of(p, CubicSplit::inflection), bends);
    check(borders_of(p, CubicSplit::extrema), turns);
    inflections += static_cast<int>(bends.size());
    extrema += static_cast<int>(turns.size());
  }
  // There were both, and neither everywhere.
  EXPECT_GT(inflections, 500);
  EXPECT_LT(inflections, 2000);
  EXPECT_GT(extrema, 500);
  EXPECT_LT(extrema, 4000);
}

TEST(CubicSplit, CutsNothingWhereThereIsNoSuchPoint) {
  const Bernstein<3> line{{0, 1, 2, 3}};
  const Bernstein<3> constant{{0.25, 0.25, 0.25, 0.25}};
  const Bernstein<3> parabola{{0, 1.0 / 3, 1.0 / 3, 0}};
  const Bernstein<3> rising{{0, 0, 0, 1}};        // u^3: its inflection is its front
  const Bernstein<3> twice_flat{{-1, 1, -1, 1}};  // (2u - 1)^3: it is flat, and rises, at its inflection
  for (const CubicSplit split : {CubicSplit::none, CubicSplit::inflection, CubicSplit::extrema, CubicSplit::fewest}) {
    EXPECT_EQ(borders_of(line, split), (std::vector<double>{0, 1}));
    EXPECT_EQ(borders_of(constant, split), (std::vector<double>{0, 1}));
  }
  EXPECT_EQ(borders_of(parabola, CubicSplit::inflection), (std::vector<double>{0, 1}));
  EXPECT_EQ(borders_of(parabola, CubicSplit::extrema), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(borders_of(parabola, CubicSplit::fewest, 0), (std::vector<double>{0, 1}));
  EXPECT_EQ(borders_of(rising, CubicSplit::inflection), (std::vector<double>{0, 1}));
  EXPECT_EQ(borders_of(rising, CubicSplit::extrema), (std::vector<double>{0, 1}));
  EXPECT_EQ(borders_of(twice_flat, CubicSplit::inflection), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(borders_of(twice_flat, CubicSplit::extrema), (std::vector<double>{0, 1}));
}

TEST(CubicSplit, OnePartIsOrder2OfTheCubicsMiddle) {
  Rules<double> rules;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto p = random_polynomial<3>(i);
    const double front = p.coefficients[0];
    const double middle = p.value(0.5);
    const double back = p.coefficients[3];
    Chain<3> second;
    second.pieces = {{0.0, 0.5, Rules<double>::cubic(rules.order2_front(front, middle, back, 0.5))},
                     {0.5, 0.5, Rules<double>::cubic(rules.order2_back(front, middle, back, 0.5))}};
    second.end = 1.0;
    EXPECT_LE(xi_max(second, parabolas(p, 1, borders_of(p, CubicSplit::none))), 4e-16);
  }
}

TEST(CubicSplit, TheMiddleGainsEightAndNoOtherPlaceMore) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    const auto p = random_polynomial<3>(i);
    const auto error = [&p](CubicSplit split) { return xi(one_piece(p, 1.0), parabolas(p, 1, borders_of(p, split))); };
    const double none = error(CubicSplit::none);
    EXPECT_NEAR(error(CubicSplit::middle), none / 8, 1e-15);
    EXPECT_LE(error(CubicSplit::inflection), none + 1e-15);
    EXPECT_GE(error(CubicSplit::inflection), none / 8 - 1e-15);
    EXPECT_GE(error(CubicSplit::extrema), none / 27 - 1e-15);  // two places at most: three parts
  }
}

TEST(CubicSplit, FewestKeepsItsToleranceAndOnePartLessDoesNot) {
  int most = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    const auto p = random_polynomial<3>(i);
    const auto parts = static_cast<int>(borders_of(p, CubicSplit::fewest).size()) - 1;
    most = std::max(most, parts);
    EXPECT_LE(xi(one_piece(p, 1.0), parabolas(p, 1, borders_of(p, CubicSplit::fewest))), tolerance + 1e-15);
    if (parts == 1) continue;
    // Not equal ones, and no others: random borders, one part less.
    EXPECT_GT(mean_split_error(p, parts - 1), tolerance);
    std::vector<double> others{0, 1};
    for (int k = 2; k < parts; ++k)
      others.push_back(random_numbers(6, RandomStream::points, i, static_cast<std::uint32_t>(k))[0]);
    std::sort(others.begin(), others.end());
    EXPECT_GT(area_of(p, 1, others), tolerance);
  }
  EXPECT_GT(most, 3);
}

TEST(CubicSplit, SlabsHaveSixPartsAtMost) {
  // The largest third difference of four samples in [0, 1].
  Samples<double> samples{.positions = {0.0, 1.0, 2.0, 3.0}, .values = {0, 1, 0, 1}, .step = 1};
  Chain<3> chain;
  approximate<CubicSplitFewest>(Chain<3>{}, samples, chain);
  EXPECT_EQ(chain.pieces.size(), 6U);
  samples.values = {1e-300, 3e-300, 1e-300, 3e-300};
  approximate<CubicSplitFewest>(Chain<3>{}, samples, chain);
  EXPECT_EQ(chain.pieces.size(), 6U);
}

TEST(CubicSplit, CutsHigherDegreesAtEverySuchPoint) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto p = random_polynomial<9>(i);
    const auto signal = one_piece(p, 1.0);
    const auto error = [&](CubicSplit split) { return xi(signal, parabolas(p, 1, borders_of(p, split))); };
    EXPECT_EQ(borders_of(p, CubicSplit::inflection).size(), p.derivative().derivative().sign_changes().size() + 2);
    EXPECT_EQ(borders_of(p, CubicSplit::extrema).size(), p.derivative().sign_changes().size() + 2);
    EXPECT_NEAR(mean_split_error(p, 2), error(CubicSplit::middle), 1e-14);
    EXPECT_LE(error(CubicSplit::fewest), tolerance);
    const auto borders = borders_of(p, CubicSplit::extrema);
    const auto chain = parabolas(p, 1, borders);
    for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
      EXPECT_EQ(chain.pieces[k].polynomial.coefficients.front(), p.value(borders[k]));
      EXPECT_EQ(chain.pieces[k].polynomial.coefficients.back(), p.value(borders[k + 1]));
      EXPECT_NEAR(chain.pieces[k].polynomial.value(0.5), p.value((borders[k] + borders[k + 1]) / 2), 2e-15);
    }
  }
}

TEST(CubicSplit, HigherDegreesAgreeWithCubics) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto cubic = random_polynomial<3>(i);
    const auto raised = cubic.elevated<9>();
    EXPECT_NEAR(mean_split_error(raised, 3), mean_split_error(cubic, 3), 1e-14);
    for (const CubicSplit split : every_split) {
      const auto own = borders_of(cubic, split);
      const auto same = borders_of(raised, split);
      ASSERT_EQ(own.size(), same.size());
      for (std::size_t k = 0; k < own.size(); ++k) EXPECT_NEAR(own[k], same[k], 1e-9);
    }
  }
}

}  // namespace
}  // namespace raytruth
