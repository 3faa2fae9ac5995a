#include "raytruth/advice/error_estimate.hpp"

#include "raytruth/core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {
namespace {

constexpr double confidence = 0.95;

/// Errors of a population, of which a sample is the first so many.
template <class Error>
std::vector<double> errors(std::uint64_t seed, std::size_t count, const Error& error) {
  std::vector<double> list;
  for (std::size_t i = 0; i < count; ++i) list.push_back(error(random_numbers(seed, RandomStream::pixels, i)));
  return list;
}

TEST(ErrorEstimate, RmseOfEqualErrorsIsThatError) {
  const ErrorEstimate estimate = rmse_of_sample(std::vector<double>(1000, 0.25), confidence);
  EXPECT_EQ(estimate.value, 0.5);
  EXPECT_LE(estimate.low, 0.5);
  EXPECT_GT(estimate.high, 0.5);
  EXPECT_LT(estimate.high, 0.52);
}

TEST(ErrorEstimate, NothingIsKnownOfOneError) {
  EXPECT_EQ(rmse_of_sample({}, confidence).high, 0);
  EXPECT_EQ(largest_of_sample({}, 10, confidence).high, 0);
}

/// Errors with a tail, mostly zero as those of pixels beside an object.
TEST(ErrorEstimate, BoundsOfTheRmseHoldForMostSamples) {
  const auto square = [](const auto& chance) { return chance[0] < 0.7 ? 0.0 : std::pow(chance[1], 8); };
  const double truth = std::sqrt(0.3 / 9);
  int held = 0;
  constexpr int samples = 200;
  for (int i = 0; i < samples; ++i) {
    const ErrorEstimate estimate = rmse_of_sample(errors(static_cast<std::uint64_t>(i), 1000, square), confidence);
    held += estimate.low <= truth && truth <= estimate.high ? 1 : 0;
    EXPECT_LT(estimate.high, 2 * truth);
  }
  EXPECT_GE(held, 0.95 * samples);
}

TEST(ErrorEstimate, TheLargestOfAPopulationIsSeldomBeyondItsBound) {
  // A bounded tail, an exponential one and a heavy one.
  const auto bounded = [](const auto& chance) { return 1 - chance[0] * chance[0]; };
  const auto exponential = [](const auto& chance) { return -std::log(1 - chance[0]); };
  const auto heavy = [](const auto& chance) { return std::pow(1 - chance[0], -0.3) - 1; };
  const auto check = [](const auto& error) {
    int held = 0;
    constexpr int samples = 100;
    constexpr std::size_t population = 30000;
    for (int i = 0; i < samples; ++i) {
      const auto all = errors(static_cast<std::uint64_t>(i), population, error);
      const double truth = *std::max_element(all.begin(), all.end());
      const std::vector<double> sample(all.begin(), all.begin() + 1500);
      const ErrorEstimate estimate = largest_of_sample(sample, population, confidence);
      EXPECT_EQ(estimate.low, *std::max_element(sample.begin(), sample.end()));
      held += truth <= estimate.high ? 1 : 0;
    }
    return held;
  };
  EXPECT_GE(check(bounded), 95);
  // The index of a tail is itself an estimate, of 150 errors here.
  EXPECT_GE(check(exponential), 85);
  EXPECT_GE(check(heavy), 85);
}

TEST(ErrorEstimate, WhatASearchFoundIsCertain) {
  const ErrorEstimate larger = and_at_least({.value = 1, .low = 0.5, .high = 3}, 2);
  EXPECT_EQ(larger.value, 2);
  EXPECT_EQ(larger.low, 2);
  EXPECT_EQ(larger.high, 3);
  EXPECT_GT(and_at_least({.value = 1, .low = 0.5, .high = 3}, 3).high, 3);
  const ErrorEstimate smaller = and_at_least({.value = 1, .low = 0.5, .high = 3}, 0.25);
  EXPECT_EQ(smaller.low, 0.5);
  EXPECT_EQ(smaller.value, 1);
  EXPECT_EQ(smaller.high, 3);
}

}  // namespace
}  // namespace raytruth
