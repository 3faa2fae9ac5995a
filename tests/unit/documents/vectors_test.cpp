#include "raytruth/documents/conformance/vectors.hpp"

#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_int.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <set>

namespace raytruth {
namespace {

using Rational = boost::multiprecision::cpp_rational;

constexpr std::uint64_t seeds = 20;

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
        expect_exact_in_binary32(optics.extinction);
        for (const double x : optics.color) expect_exact_in_binary32(x);
      }
    }
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
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
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
    for (const ConformanceVector& vector : conformance_vectors(seed)) {
      const Certified truth = truth_of(vector);
      EXPECT_EQ(truth.status, Status::converged) << vector.id;
      EXPECT_LT(truth.radius, 1e-12 * truth.opacity) << vector.id;
      EXPECT_LT(truth.radius, 1e-12 * truth.color.maxCoeff()) << vector.id;
    }
}

TEST(Vectors, SeedsDiffer) {
  EXPECT_EQ(vectors_json(1), vectors_json(1));
  EXPECT_NE(vectors_json(1).at("vectors"), vectors_json(2).at("vectors"));
}

const Certified truth{{.color = {0.5, 0.25, 0}, .opacity = 0.125}, 1e-14};

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
  EXPECT_NEAR(scores[0].digits_min, 2, 1e-9);
  EXPECT_NEAR(scores[0].digits_median, 3, 1e-9);
  EXPECT_EQ(scores[1].cases, 2);
  EXPECT_EQ(scores[1].answered, 1);
  EXPECT_EQ(scores[1].worst, "e");
  EXPECT_NEAR(scores[1].digits_median, 0.5, 1e-9);
  EXPECT_EQ(scores[2].level, "all");
  EXPECT_EQ(scores[2].cases, 5);
  EXPECT_NEAR(scores[2].digits_median, 2, 1e-9);
}

}  // namespace
}  // namespace raytruth
