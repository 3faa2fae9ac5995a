#include "raytruth/shading/highlight.hpp"
#include "raytruth/core/named.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace raytruth {
namespace {

constexpr std::array shininesses{1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 80.5, 100.0};
constexpr double infinity = std::numeric_limits<double>::infinity();

const Highlight& highlight_of(std::string_view name) {
  const Highlight* highlight = find_named(catalogue::highlights(), name);
  if (highlight == nullptr) throw std::logic_error(std::string(name));
  return *highlight;
}

/// The most positive and the most negative deviation from the lobe on a grid of angles.
std::pair<double, double> deviations(int degree, double exponent, double shininess) {
  const Highlight member{.name = {}, .summary = {}, .source = {}, .degree = degree, .ratio = nullptr};
  double highest = 0;
  double lowest = 0;
  for (int i = 0; i <= 20000; ++i) {
    const double cosine = std::max(0.0, std::cos(i * std::acos(0.0) / 20000));
    const double deviation = member.value_at_exponent(cosine, exponent) - std::pow(cosine, shininess);
    highest = std::max(highest, deviation);
    lowest = std::min(lowest, deviation);
  }
  return {highest, lowest};
}

TEST(Highlight, TheConeDeviatesMostWhereItBegins) {
  for (const double n : shininesses) {
    const auto [highest, lowest] = deviations(1, n, n);
    EXPECT_LE(highest, 1e-15) << n;  // Bernoulli: it never exceeds the lobe
    const double closed_form = std::pow(1 - 1 / n, n);
    EXPECT_NEAR(-lowest, closed_form, 1e-4) << n;  // of a grid
    const LargestDeviation largest = largest_deviation(highlight_of("cone"), n);
    EXPECT_NEAR(largest.deviation, -closed_form, 1e-14) << n;
    EXPECT_NEAR(1 - largest.fall / n, n > 1 ? 1 - 1 / n : 1, 1e-14) << n;
    EXPECT_LE(highlight_of("cone").value(1 - 1 / n, n), n * 2.3e-16) << n;  // rounding of the cosine, n times
    EXPECT_GT(highlight_of("cone").value(1 - 1 / n + 1e-12, n), 0) << n;
    EXPECT_NEAR(highlight_of("cone").threshold(n), 1 - 1 / n, 1e-15);
  }
  EXPECT_NEAR(largest_deviation(highlight_of("cone"), infinity).deviation, -std::exp(-1), 1e-15);
}

TEST(Highlight, TheConeLosesEnergyAndConeEnergyDoesNot) {
  const auto energy = [](const Highlight& highlight, double n) {
    const auto over = [&](double low, double high) {
      return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
          [&](double theta) { return highlight.value(std::cos(theta), n) * std::sin(theta); }, low, high, 10, 1e-12);
    };
    const double foot = std::acos(highlight.threshold(n));
    return over(0, foot) + over(foot, std::acos(0.0));
  };
  for (const double n : shininesses) {
    EXPECT_NEAR(energy(highlight_of("lobe"), n) * (n + 1), 1, 8e-15) << n;
    EXPECT_NEAR(energy(highlight_of("cone"), n) * (n + 1), (n + 1) / (2 * n), 8e-15) << n;
    EXPECT_NEAR(energy(highlight_of("cone_energy"), n) * (n + 1), 1, 8e-15) << n;
  }
}

TEST(Highlight, MinimaxMembersDeviateAsFarToOneSideAsToTheOther) {
  for (int degree = 1; degree <= 3; ++degree)
    for (const double n : shininesses) {
      const double exponent = n * minimax_ratio(n, degree);
      if (n == degree) {  // the lobe itself
        EXPECT_EQ(exponent, n);
        continue;
      }
      const auto [highest, lowest] = deviations(degree, exponent, n);
      EXPECT_NEAR(highest, -lowest, 1e-4) << degree << ' ' << n;  // of a grid
      EXPECT_GT(highest, 1e-4);
      for (const double factor : {0.9, 0.98, 1.02, 1.1}) {
        const auto [other_highest, other_lowest] = deviations(degree, factor * exponent, n);
        EXPECT_GT(std::max(other_highest, -other_lowest), 1.005 * highest) << degree << ' ' << n << ' ' << factor;
      }
    }
}

TEST(Highlight, MinimaxExponentsTendToALimit) {
  // The limit of the cone solves 1 - k + k log(k) = exp(-1/k): both of its extremes have a closed form.
  const double k = minimax_ratio(infinity, 1);
  EXPECT_NEAR(1 - k + k * std::log(k), std::exp(-1 / k), 1e-14);
  for (int degree = 1; degree <= 3; ++degree)
    EXPECT_NEAR(minimax_ratio(1e6, degree), minimax_ratio(infinity, degree), 2e-6) << degree;
}

TEST(Highlight, LargestDeviationsAreThoseOfAGrid) {
  for (const Highlight& highlight : catalogue::highlights())
    for (const double n : shininesses) {
      if (highlight.degree == 0) continue;
      const auto [highest, lowest] = deviations(highlight.degree, highlight.exponent(n), n);
      EXPECT_NEAR(std::abs(largest_deviation(highlight, n).deviation), std::max(highest, -lowest), 1e-4)
          << highlight.name << ' ' << n;
    }
}

TEST(Highlight, IsOneInTheMiddleAndNothingBehind) {
  for (const Highlight& highlight : catalogue::highlights())
    for (const double n : shininesses) {
      EXPECT_EQ(highlight.value(1, n), 1) << highlight.name;
      if (n >= 3) {
        EXPECT_EQ(highlight.value(-0.1, n), 0) << highlight.name << ' ' << n;
      }
      for (double cosine = -1; cosine < 1; cosine += 0.01)
        EXPECT_LE(highlight.value(cosine, n), highlight.value(cosine + 0.01, n)) << highlight.name;
    }
}

TEST(Highlight, NamesAreFound) { EXPECT_EQ(find_named(catalogue::highlights(), "disc"), nullptr); }

}  // namespace
}  // namespace raytruth
