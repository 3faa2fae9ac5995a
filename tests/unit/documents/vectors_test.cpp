#include "raytruth/documents/conformance/vectors.hpp"

#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_int.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace raytruth {
namespace {

using Rational = boost::multiprecision::cpp_rational;

constexpr std::uint64_t seeds = 20;

/// Vectors whose certified answers are asked for: ball arithmetic takes a second for what a seed adds to the first
/// form.
std::vector<ConformanceVector> integrated_vectors(std::uint64_t seed) {
  return conformance_vectors(seed, seed == 1 ? VectorForm::second : VectorForm::first);
}

/// Bernstein coefficients of degree 9 of a polynomial in powers of t, exactly: b_i = sum_k binomial(i, k) /
/// binomial(9, k) a_k length^k.
std::vector<Rational> exact_bernstein(const std::vector<double>& powers, double length) {
  const auto binomial = [](unsigned n, unsigned k) {
    Rational result = 1;
    for (unsigned j = 0; j < k; ++j) result = result * (n - j) / (j + 1);
    return result;
  };
  std::vector<Rational> result(10);
  for (unsigned i = 0; i <= 9; ++i) {
    Rational factor = 1;
    for (unsigned k = 0; k < powers.size() && k <= i; ++k) {
      result[i] += binomial(i, k) / binomial(9, k) * Rational(powers[k]) * factor;
      factor *= Rational(length);
    }
  }
  return result;
}

void expect_exact_in_binary32(double x) { EXPECT_EQ(static_cast<double>(static_cast<float>(x)), x); }

TEST(Vectors, EveryNumberIsExactInBinary32) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
      SCOPED_TRACE(vector.id);
      for (const double x : vector.breaks) expect_exact_in_binary32(x);
      for (const auto& piece : vector.coefficients)
        for (const double x : piece) expect_exact_in_binary32(x);
      for (const auto& [s, optics] : vector.transfer.points()) {
        expect_exact_in_binary32(s);
        if (!vector.transfer.is_linear_in_opacity()) expect_exact_in_binary32(optics.extinction);
        for (const double x : optics.color) expect_exact_in_binary32(x);
      }
      for (const double x : vector.transfer.opacities()) expect_exact_in_binary32(x);
      expect_exact_in_binary32(vector.transfer.unit_length());
      if (!vector.lists) continue;
      for (const auto& [s, color] : vector.lists->colors) {
        expect_exact_in_binary32(s);
        for (const double x : color) expect_exact_in_binary32(x);
      }
      for (const auto& [s, value] : vector.lists->densities) {
        expect_exact_in_binary32(s);
        expect_exact_in_binary32(value);
      }
    }
}

/// What a list is at s, from below or from above, exactly; `value_of` gives the number of one of its points.
template <class Point, class ValueOf>
Rational in_list(const std::vector<Point>& list, double s, bool is_below, ValueOf value_of) {
  std::size_t next = 0;
  while (next < list.size() && (is_below ? list[next].s < s : list[next].s <= s)) ++next;
  if (next == 0) return Rational(value_of(list.front()));
  if (next == list.size()) return Rational(value_of(list.back()));
  const auto& a = list[next - 1];
  const auto& b = list[next];
  const Rational weight = (Rational(s) - Rational(a.s)) / (Rational(b.s) - Rational(a.s));
  return Rational(value_of(a)) + weight * (Rational(value_of(b)) - Rational(value_of(a)));
}

// So nobody is asked anything else who takes the one list instead of the two.
TEST(Vectors, SeparateListsAreTheJoinedOneExactly) {
  int jumps = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
      SCOPED_TRACE(vector.id);
      EXPECT_EQ(vector.lists.has_value(), vector.level == "separate_lists");
      if (!vector.lists) continue;
      const SeparateLists& lists = *vector.lists;
      const auto& points = vector.transfer.points();
      const bool is_opacity = vector.transfer.is_linear_in_opacity();
      EXPECT_EQ(vector.transfer.unit_length(), lists.unit_length);
      std::set<double> scalars;
      for (const auto& point : lists.colors) scalars.insert(point.s);
      for (const auto& point : lists.densities) scalars.insert(point.s);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double s = points[i].s;
        scalars.erase(s);
        const bool is_below = i + 1 < points.size() && points[i + 1].s == s;
        jumps += is_below ? 1 : 0;
        EXPECT_EQ(Rational(is_opacity ? vector.transfer.opacities()[i] : points[i].optics.extinction),
                  in_list(lists.densities, s, is_below, [](const auto& point) { return point.value; }));
        for (Eigen::Index channel = 0; channel < 3; ++channel)
          EXPECT_EQ(Rational(points[i].optics.color[channel]),
                    in_list(lists.colors, s, is_below, [&](const auto& point) { return point.color[channel]; }));
      }
      EXPECT_TRUE(scalars.empty());
      // Neither list has the points of the other.
      for (const auto& color : lists.colors)
        for (const auto& density : lists.densities) EXPECT_NE(color.s, density.s);
    }
  EXPECT_GT(jumps, 0);
}

TEST(Vectors, RaysOfTheSecondFormAreLinearBetweenEquidistantSamples) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto first = conformance_vectors(seed, VectorForm::first);
    const auto all = conformance_vectors(seed);
    for (std::size_t i = first.size(); i < all.size(); ++i) {
      SCOPED_TRACE(all[i].id);
      const auto chain = signal_of(all[i]);
      EXPECT_EQ(chain.pieces.size() == 1, all[i].is_slab);
      for (std::size_t piece = 0; piece < chain.pieces.size(); ++piece) {
        EXPECT_EQ(chain.pieces[piece].length, chain.pieces[0].length);
        EXPECT_EQ(all[i].coefficients[piece].size(), 2);
        if (piece == 0) continue;
        EXPECT_EQ(chain.pieces[piece].polynomial.coefficients.front(),
                  chain.pieces[piece - 1].polynomial.coefficients.back());
      }
    }
  }
}

TEST(Vectors, OpacitiesReachOneAtPointsAndOnStretches) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    int contacts = 0;
    int opaque = 0;
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
      if (vector.level != "opacity_linear") continue;
      const auto& opacities = vector.transfer.opacities();
      const auto ones = std::count(opacities.begin(), opacities.end(), 1);
      contacts += ones == 1 ? 1 : 0;
      opaque += ones == 2 ? 1 : 0;
      // What has passed a contact alone is not opaque, what ends on a stretch is.
      const Certified truth = RayIntegral(vector.transfer, vector.emission)(signal_of(vector));
      EXPECT_EQ(truth.opacity == 1, ones == 2) << vector.id;
    }
    EXPECT_EQ(contacts, 5);
    EXPECT_EQ(opaque, 5);
  }
}

TEST(Vectors, IsoslabsAreAloneOnTheRay) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
      if (vector.level != "isoslab") continue;
      SCOPED_TRACE(vector.id);
      const auto& points = vector.transfer.points();
      ASSERT_TRUE(points.size() == 6 || points.size() == 10);
      for (std::size_t i = 1; i + 1 < points.size(); i += 4) {
        EXPECT_EQ(vector.transfer.before(points[i].s).extinction, 0);
        EXPECT_GT(points[i + 1].optics.extinction, 0);
        EXPECT_EQ(points[i + 1].optics.extinction, points[i + 2].optics.extinction);
        EXPECT_TRUE((points[i + 1].optics.color == points[i + 2].optics.color).all());
        EXPECT_EQ(vector.transfer.at(points[i + 2].s).extinction, 0);
        EXPECT_TRUE((vector.transfer.at(points[i + 2].s).color == 0).all());
      }
    }
}

// Whoever reads the first form finds it again.
TEST(Vectors, FirstFormIsTheBeginningOfTheSecond) {
  const auto first = vectors_json(3, VectorForm::first);
  const auto second = vectors_json(3);
  EXPECT_EQ(first.at("raytruth"), "vectors/1");
  EXPECT_EQ(second.at("raytruth"), "vectors/2");
  for (const char* const list : {"levels", "vectors"}) {
    ASSERT_LT(first.at(list).size(), second.at(list).size());
    for (std::size_t i = 0; i < first.at(list).size(); ++i) EXPECT_EQ(first.at(list)[i], second.at(list)[i]);
  }
  EXPECT_EQ(first.at("vectors").size(), 140);
  EXPECT_EQ(second.at("vectors").size(), 204);
}

// So the reference needs no allowance for the rounding of the signal.
TEST(Vectors, ChainsAreExact) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
      SCOPED_TRACE(vector.id);
      const auto chain = signal_of(vector);
      for (std::size_t piece = 0; piece < chain.pieces.size(); ++piece) {
        EXPECT_EQ(static_cast<double>(chain.pieces[piece].start), vector.breaks[piece]);
        const auto exact = exact_bernstein(vector.coefficients[piece], vector.breaks[piece + 1] - vector.breaks[piece]);
        for (std::size_t i = 0; i < exact.size(); ++i)
          EXPECT_EQ(Rational(chain.pieces[piece].polynomial.coefficients[i]), exact[i]);
      }
    }
}

TEST(Vectors, ScalarsAreThoseOfTheTransferFunction) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
      const auto [low, high] = signal_of(vector).range();
      EXPECT_GE(low, 0) << vector.id;
      EXPECT_LE(high, 1) << vector.id;
    }
}

TEST(Vectors, EveryLevelHasBothConventionsAndEveryDegree) {
  const auto vectors = conformance_vectors(1);
  std::set<std::size_t> degrees;
  for (const VectorLevel& level : vector_levels()) {
    std::set<std::pair<bool, Emission>> kinds;
    for (const ConformanceVector& vector : vectors)
      if (vector.level == level.name) kinds.insert({vector.is_slab, vector.emission});
    EXPECT_EQ(kinds.size(), level.name == "non_monotone" ? 2 : 4) << level.name;
  }
  for (const ConformanceVector& vector : vectors)
    for (const auto& piece : vector.coefficients) degrees.insert(piece.size() - 1);
  EXPECT_EQ(degrees, (std::set<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

// Two certified integrations that share no step.
TEST(Vectors, BothReferencesMeet) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const ConformanceVector& vector : integrated_vectors(seed)) {
      SCOPED_TRACE(vector.id);
      const Certified truth = truth_of(vector);
      const Certified fast = RayIntegral(vector.transfer, vector.emission)(signal_of(vector));
      const double radius = truth.radius + fast.radius;
      EXPECT_LE((truth.color - fast.color).abs().maxCoeff(), radius);
      EXPECT_LE(std::abs(truth.opacity - fast.opacity), radius);
    }
}

TEST(Vectors, ReferenceIsCloseEnoughToCountDigits) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const ConformanceVector& vector : integrated_vectors(seed)) {
      const Certified truth = truth_of(vector);
      EXPECT_EQ(truth.status, Status::converged) << vector.id;
      EXPECT_LT(truth.radius, 1e-12 * truth.opacity) << vector.id;
      EXPECT_LT(truth.radius, 1e-12 * truth.color.maxCoeff()) << vector.id;
    }
}

TEST(Vectors, SeedsDiffer) {
  const auto of_seed = [](std::uint64_t seed) { return vectors_json(seed, VectorForm::first); };
  EXPECT_EQ(of_seed(1), of_seed(1));
  EXPECT_NE(of_seed(1).at("vectors"), of_seed(2).at("vectors"));
}

const Certified truth{{.color = {0.5, 0.25, 0}, .opacity = 0.125}, 1e-14};

double digits_correct(const Answer& answer, const Certified& certified) { return score_of(answer, certified).digits(); }

TEST(DigitsCorrect, AreThoseOfTheWorstChannel) {
  EXPECT_NEAR(digits_correct({{0.5, 0.25 + 0.5e-3, 0.5e-5}, 0.125}, truth), 3, 1e-9);
  EXPECT_NEAR(digits_correct({{0.5 - 0.5e-6, 0.25, 0}, 0.125 + 0.125e-4}, truth), 4, 1e-9);
}

TEST(DigitsCorrect, AreBoundedByZeroAndByTheRadius) {
  EXPECT_NEAR(digits_correct({truth.color, truth.opacity}, truth), -std::log10(1e-14 / 0.125), 1e-9);
  EXPECT_EQ(digits_correct({truth.color * 3, truth.opacity}, truth), 0);
  EXPECT_EQ(digits_correct({truth.color, 1e308}, truth), 0);
  EXPECT_NEAR(digits_correct({truth.color, truth.opacity}, {{.color = truth.color, .opacity = 0.125}}),
              53 * std::log10(2), 1e-9);
}

TEST(DigitsCorrect, OfNothing) {
  const Certified nothing{{}, 1e-20};
  EXPECT_NEAR(digits_correct({{0, 0, 0}, 0}, nothing), 53 * std::log10(2), 1e-9);
  EXPECT_EQ(digits_correct({{0, 0, 0}, 1e-19}, nothing), 0);
}

TEST(ScoreOf, TellsColorAndOpacityApart) {
  const AnswerScore score = score_of({{0.5, 0.25 + 0.5e-3, 0.5e-5}, 0.125 - 0.125e-6}, truth);
  EXPECT_NEAR(score.color_error, 0.5e-3, 1e-15);
  EXPECT_NEAR(score.opacity_error, 0.125e-6, 1e-15);
  EXPECT_NEAR(score.color_digits, 3, 1e-9);
  EXPECT_NEAR(score.opacity_digits, 6, 1e-8);
  EXPECT_EQ(score.digits(), score.color_digits);
  EXPECT_EQ(score.error(), score.color_error);
}

TEST(ScoreOf, WhatIsNotFiniteCostsItsOwnDigits) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  for (const double color : {nothing, std::numeric_limits<double>::infinity()}) {
    const AnswerScore score = score_of({{color, 0.25, 0}, truth.opacity}, truth);
    EXPECT_EQ(score.color_digits, 0);
    EXPECT_GT(score.opacity_digits, 12);
    EXPECT_FALSE(std::isfinite(score.color_error));
    EXPECT_EQ(score.digits(), 0);
  }
  const AnswerScore score = score_of({truth.color, nothing}, truth);
  EXPECT_EQ(score.opacity_digits, 0);
  EXPECT_EQ(score.color_error, 0);
  EXPECT_EQ(score.digits(), 0);
}

TEST(Score, IsOverWhatWasAnswered) {
  const Answer exact{truth.color, truth.opacity};
  const Answer broken{truth.color, std::numeric_limits<double>::quiet_NaN()};
  const auto scores = score({{"a", "half", truth, std::nullopt},
                             {"b", "half", truth, exact},
                             {"c", "half", truth, Answer{truth.color + 0.5e-3, truth.opacity}},
                             {"d", "none", truth, std::nullopt},
                             {"e", "broken", truth, broken}});
  ASSERT_EQ(scores.size(), 4);
  EXPECT_EQ(scores[0].worst, "c");
  EXPECT_EQ(scores[0].answered, 2);
  EXPECT_NEAR(*scores[0].digits_min, 3, 1e-9);
  EXPECT_NEAR(*scores[0].color.error_max, 0.5e-3, 1e-15);
  EXPECT_EQ(*scores[0].opacity.error_max, 0);
  EXPECT_GT(*scores[0].opacity.digits_min, 12);
  EXPECT_EQ(scores[1].cases, 1);
  EXPECT_EQ(scores[1].answered, 0);
  EXPECT_FALSE(scores[1].digits_min || scores[1].digits_median || scores[1].worst || scores[1].color.error_max);
  EXPECT_EQ(scores[2].not_finite, 1);
  EXPECT_EQ(scores[2].digits_min, 0);
  EXPECT_EQ(scores[2].color.error_max, 0);
  EXPECT_FALSE(scores[2].opacity.error_max);
  EXPECT_EQ(scores[3].not_finite, 1);
}

TEST(Score, HasWorstAndMedianOfEveryLevel) {
  const auto answer = [](double error) { return Answer{truth.color + 0.5 * error, truth.opacity}; };
  const auto scores = score({{"a", "easy", truth, answer(1e-3)},
                             {"b", "hard", truth, answer(1e-1)},
                             {"c", "easy", truth, answer(1e-2)},
                             {"d", "easy", truth, answer(1e-5)},
                             {"e", "hard", truth, std::nullopt}});
  ASSERT_EQ(scores.size(), 3);
  EXPECT_EQ(scores[0].level, "easy");
  EXPECT_EQ(scores[0].worst, "c");
  EXPECT_NEAR(*scores[0].digits_min, 2, 1e-9);
  EXPECT_NEAR(*scores[0].digits_median, 3, 1e-9);
  EXPECT_EQ(scores[1].cases, 2);
  EXPECT_EQ(scores[1].answered, 1);
  EXPECT_EQ(scores[1].worst, "b");
  EXPECT_NEAR(*scores[1].digits_median, 1, 1e-9);
  EXPECT_EQ(scores[2].level, "all");
  EXPECT_EQ(scores[2].cases, 5);
  EXPECT_NEAR(*scores[2].digits_median, 2.5, 1e-9);
}

}  // namespace
}  // namespace raytruth
