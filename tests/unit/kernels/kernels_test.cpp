#include "raytruth/kernels/kernels.hpp"

#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/kernels/cell_kernels.hpp"
#include "raytruth/kernels/exponential.hpp"
#include "raytruth/kernels/gauss_legendre.hpp"
#include "raytruth/reference/piece_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace raytruth {
namespace {

double uniform(std::uint64_t stream, std::uint64_t index) {
  std::mt19937_64 generator(1000003 * stream + index);
  return static_cast<double>(generator() >> 11) * 0x1p-53;
}

TEST(Exponential, StaysWithinItsBoundEverywhere) {
  double worst = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const double y = -uniform(0, i) * (i % 2 == 0 ? 1 : 700);
    const Real50 exact = exp(Real50(y));
    worst = std::max(worst, std::abs(to_double(Real50((Real50(exponential(y)) - exact) / exact))));
  }
  EXPECT_LE(worst, exponential_error);
  EXPECT_GT(worst, exponential_error / 4);  // the bound is no fantasy
  EXPECT_EQ(exponential(0.0), 1);
  EXPECT_EQ(exponential(-1e300), exponential(-700.0));
}

TEST(Exponential, ItsPolynomialLeavesOutATenthOfAUnitAndHalfAOneLessOne) {
  Real50 worst = 0;
  Real50 worst_less_1 = 0;
  constexpr int steps = 2000;  // the error turns twelve times
  for (int i = -steps; i <= steps; ++i) {
    if (i == 0) continue;
    const Real50 r = Real50(0.3466) * i / steps;
    Real50 g = 0;
    for (std::size_t k = exponential_coefficients.size(); k-- > 0;) g = g * r + exponential_coefficients[k];
    const Real50 missed = abs(Real50(r + r * r * g - boost::multiprecision::expm1(r)));
    worst = std::max<Real50>(worst, missed * exp(Real50(-r)));
    worst_less_1 = std::max<Real50>(worst_less_1, missed / abs(boost::multiprecision::expm1(r)));
  }
  EXPECT_LE(worst_less_1, 0.5 * unit_roundoff);
  EXPECT_LE(worst, 0.1 * unit_roundoff);
}

TEST(Exponential, PowersOfTwoAndWhatTheyAreLessOneStayWithinTheirBounds) {
  double worst = 0;
  double worst_less_1 = 0;
  const auto relative_error = [](double value, const Real50& exact) {
    return std::abs(to_double(Real50((Real50(value) - exact) / exact)));
  };
  for (std::uint64_t i = 0; i < 40000; ++i) {
    const double largest = std::array{1.0, 60.0, 900.0, 1e-9}[i % 4];
    const double y = (2 * uniform(4, i) - 1) * largest;
    const PowerOf2 power(y);
    const Real50 exponent = Real50(y) * log(Real50(2));
    worst = std::max(worst, relative_error(power.value(), exp(exponent)));
    worst_less_1 = std::max(worst_less_1, relative_error(power.less_1(), boost::multiprecision::expm1(exponent)));
  }
  EXPECT_LE(worst, PowerOf2<double>::error);
  EXPECT_LE(worst_less_1, PowerOf2<double>::error_less_1);
  EXPECT_GT(worst, PowerOf2<double>::error / 4);
  EXPECT_GT(worst_less_1, PowerOf2<double>::error_less_1 / 4);
  EXPECT_EQ(PowerOf2(0.0).value(), 1);
  EXPECT_EQ(PowerOf2(0.0).less_1(), 0);
}

TEST(Exponential, ThePowerAboveIsAboveAndNear) {
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const double y = 2000 * uniform(3, i) - 1000;
    EXPECT_GE(power_of_2_above(y), std::exp2(y) * (1 - 0x1p-39));
    EXPECT_LE(power_of_2_above(y), std::exp2(y) * 1.07);
  }
  EXPECT_EQ(power_of_2_above(-1e300), 0x1p-1000);
}

TEST(Exponential, ItsLogarithmIsNeverBelow) {
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const double x = std::ldexp(1 + uniform(1, i), static_cast<int>(1200 * uniform(2, i)) - 600);
    EXPECT_GE(log2_above(x), std::log2(x));
    EXPECT_LE(log2_above(x), std::log2(x) + 0.09);
  }
}

TEST(NodeTable, IntegratesPolynomialsOfTwiceItsCount) {
  for (const std::size_t count : {1U, 2U, 5U, 8U, 13U, 40U}) {
    const auto& table = node_table<3>(count);
    for (std::size_t j = 0; j <= 3; ++j) {
      double sum = 0;
      for (std::size_t i = 0; i < most_nodes; ++i) sum += table.weights[i] * table.signal_basis[j][i];
      // One node is the middle, where the basis is C(3, j) / 8.
      EXPECT_NEAR(sum, count >= 2 ? 1.0 / 4 : (j % 3 == 0 ? 1.0 : 3.0) / 8, 1e-15);
    }
    for (std::size_t j = 0; j <= 2; ++j) {
      const NodeRow& row = table.weighted_rate_basis[j];
      const double sum = std::accumulate(row.begin(), row.end(), 0.0);
      EXPECT_NEAR(sum, count >= 2 ? 1.0 / 3 : (j == 1 ? 2.0 : 1.0) / 4, 1e-15);
    }
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j <= 4; ++j) sum += table.depth_basis[j][i];
      EXPECT_NEAR(sum, 1, 1e-15);
    }
  }
}

/// A piece whose coefficients lie in [low, high], of this optical depth.
template <int Degree>
LinearPiece<Degree> random_piece(std::uint64_t index, double depth, double low = 0, double high = 1) {
  LinearPiece<Degree> piece{.length = 1};
  piece.extinction_at_0 = uniform(3, index);
  piece.extinction_at_1 = uniform(4, index);
  double mean = 0;
  for (std::size_t j = 0; j <= Degree; ++j) {
    piece.x[j] = low + (high - low) * uniform(5 + j, index);
    mean += (piece.extinction_at_0 * (1 - piece.x[j]) + piece.extinction_at_1 * piece.x[j]) / (Degree + 1);
  }
  piece.extinction_at_0 *= depth / mean;
  piece.extinction_at_1 *= depth / mean;
  return piece;
}

/// The integrals of a piece in 50 digits, by Gauss's rule on many parts.
template <int Degree>
std::array<Real50, 3> exact_integrals(const LinearPiece<Degree>& piece, Emission emission) {
  Bernstein<Degree, Real50> x;
  Bernstein<Degree, Real50> extinction;
  for (std::size_t j = 0; j <= Degree; ++j) {
    x.coefficients[j] = piece.x[j];
    extinction.coefficients[j] =
        Real50(piece.extinction_at_0) * (1 - Real50(piece.x[j])) + Real50(piece.extinction_at_1) * Real50(piece.x[j]);
  }
  const auto depth = extinction.antiderivative();
  const auto weight = [&](bool of_1, const Real50& u) {
    const Real50 scalar = x.value(u);
    const Real50 density = emission == Emission::associated ? extinction.value(u) : Real50(1);
    return Real50((of_1 ? scalar : Real50(1 - scalar)) * density * exp(-Real50(piece.length) * depth.value(u)));
  };
  std::array<Real50, 3> result{0, 0, Real50(piece.length) * depth.coefficients.back()};
  constexpr int parts = 8;
  for (int part = 0; part < parts; ++part)
    for (const bool of_1 : {false, true})
      result[of_1 ? 1 : 0] += Real50(piece.length) * boost::math::quadrature::gauss<Real50, 25>::integrate(
                                                         [&](const Real50& u) { return weight(of_1, u); },
                                                         Real50(part) / parts, Real50(part + 1) / parts);
  return result;
}

template <int Degree>
void expect_enclosed(const PieceIntegral<>& integral, const std::array<Real50, 3>& exact, double most_radius) {
  const auto distance = [](double a, const Real50& b) { return std::abs(to_double(Real50(Real50(a) - b))); };
  EXPECT_LE(distance(integral.weight_0, exact[0]), integral.weight_error);
  EXPECT_LE(distance(integral.weight_1, exact[1]), integral.weight_error);
  EXPECT_LE(distance(integral.depth, exact[2]), integral.depth_error);
  EXPECT_LE(integral.weight_error, most_radius);
}

template <int Degree>
void check_pieces(Emission emission, double depth, double most_radius) {
  for (std::uint64_t i = 0; i < 8; ++i) {
    const auto piece = random_piece<Degree>(i, depth);
    const auto exact = exact_integrals(piece, emission);
    expect_enclosed<Degree>(integrate(piece, emission), exact, most_radius);
    expect_enclosed<Degree>(integrate_scalar(piece, emission), exact, most_radius);
  }
}

TEST(PieceIntegral, EnclosesFiftyDigitsAtEveryDepth) {
  for (const Emission emission : {Emission::associated, Emission::plain})
    for (const double depth : {1e-9, 0.01, 0.3, 3.0, 30.0}) {
      check_pieces<3>(emission, depth, emission == Emission::plain ? 1e-14 : 1e-14 * std::min(1.0, 10 * depth));
      check_pieces<9>(emission, depth, 3e-14);
    }
}

TEST(PieceIntegral, CoefficientsOutsideTheIntervalKeepTheBound) {
  for (const Emission emission : {Emission::associated, Emission::plain})
    for (std::uint64_t i = 0; i < 8; ++i) {
      const auto piece = random_piece<3>(i, 1, -0.4, 1.4);
      expect_enclosed<3>(integrate(piece, emission), exact_integrals(piece, emission), 1e-13);
    }
}

/// The piece in all lanes.
template <int Degree>
LinearPiece<Degree, Eight> eightfold(const LinearPiece<Degree>& piece) {
  LinearPiece<Degree, Eight> result;
  for (std::size_t j = 0; j <= Degree; ++j) result.x[j].fill(piece.x[j]);
  result.x_error.fill(piece.x_error);
  result.extinction_at_0.fill(piece.extinction_at_0);
  result.extinction_at_1.fill(piece.extinction_at_1);
  result.length.fill(piece.length);
  return result;
}

/// All of the scalar is off by its whole error: from rounding's size up, at all depths, in and out of [0, 1] and next
/// to its ends, where tau may vanish.
template <int Degree>
void check_errors_of_the_scalar(Emission emission) {
  constexpr std::array<std::array<double, 2>, 5> ranges{
      {{0, 1}, {-0.4, 1.4}, {-0x1p-30, 0x1p-20}, {1 - 0x1p-20, 1}, {0.3, 0.3}}};
  for (std::uint64_t i = 0; i < 40; ++i) {
    const auto [low, high] = ranges[i % ranges.size()];
    auto piece = random_piece<Degree>(i, std::pow(10, 10.4 * uniform(90, i) - 9), low, high);
    if (i % 3 == 0) piece.extinction_at_0 = 0;
    piece.x_error = std::exp2(-17 - std::floor(32 * uniform(91, i)));
    auto moved = piece;
    for (std::size_t j = 0; j <= Degree; ++j) {
      piece.x[j] = std::ldexp(std::round(std::ldexp(piece.x[j], 40)), -40);  // so that the sum is exact
      moved.x[j] = piece.x[j] + (i % 2 == 0 ? 1 : -1) * piece.x_error;
    }
    const auto exact = exact_integrals(moved, emission);
    expect_enclosed<Degree>(integrate(piece, emission), exact, HUGE_VAL);
    expect_enclosed<Degree>(integrate_scalar(piece, emission), exact, HUGE_VAL);
    const auto together = integrate(eightfold(piece), emission);
    expect_enclosed<Degree>({.weight_0 = together.weight_0[3],
                             .weight_1 = together.weight_1[3],
                             .weight_error = together.weight_error[3],
                             .depth = together.depth[3],
                             .depth_error = together.depth_error[3]},
                            exact, 200 * piece.x_error + 3e-14 * (1 + to_double(abs(exact[2]))));
  }
}

TEST(PieceIntegral, ErrorsOfTheScalarAreCovered) {
  for (const Emission emission : {Emission::associated, Emission::plain}) {
    check_errors_of_the_scalar<3>(emission);
    check_errors_of_the_scalar<9>(emission);
  }
}

/// 1/2 and as much of T_n(2u - 1), n the degree, as leaves the coefficients in [0, 1]: of T_n coefficient j is
/// (-1)^(n-j) C(2n, 2j) / C(n, j). All of what varies in its depth has the highest frequencies that there are.
template <int Degree>
LinearPiece<Degree> swinging_piece(double depth) {
  Bernstein<Degree> highest;
  double coefficient = -1;  // of an odd degree
  for (int j = 0; j <= Degree; ++j) {
    highest.coefficients[static_cast<std::size_t>(j)] = coefficient;
    coefficient *= -(2.0 * Degree - 2 * j - 1) / (2 * j + 1);
  }
  const double largest = *std::max_element(highest.coefficients.begin(), highest.coefficients.end());
  LinearPiece<Degree> piece{.extinction_at_1 = 2 * depth, .length = 1};
  for (std::size_t j = 0; j <= Degree; ++j) piece.x[j] = 0.5 + highest.coefficients[j] / (2 * largest);
  return piece;
}

TEST(PieceIntegral, TheHighestFrequenciesOfTheDepthAreCovered) {
  for (const Emission emission : {Emission::associated, Emission::plain})
    for (const double depth : {0.1, 1.0, 8.0, 24.0}) {
      const auto check = [&]<int Degree>(const LinearPiece<Degree>& piece) {
        const auto exact = exact_integrals(piece, emission);
        for (const auto& integral : {integrate(piece, emission), integrate_scalar(piece, emission)})
          expect_enclosed<Degree>(integral, exact, 3e-14);
      };
      check(swinging_piece<3>(depth));
      check(swinging_piece<9>(depth));
    }
}

/// The halves of an opacity piece are within their errors of what they should be.
TEST(OpacityPiece, HalvesCarryWhatTheyRound) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    OpacityPiece<9> piece{.x_error = 0x1p-60, .clear_error = 0x1p-60, .length = 1, .units = 1};
    for (std::size_t j = 0; j <= 9; ++j) {
      piece.x[j] = 3 * uniform(70 + j, i) - 1;
      piece.opacity[j] = 0.7 * uniform(80 + j, i);
      piece.clear[j] = 1 - piece.opacity[j];
    }
    const auto halved = halves(piece);
    const auto expect_half = [&](const OpacityPiece<9>& half, double begin, double end) {
      const auto expect_near = [&](const std::array<double, 10>& found, const std::array<double, 10>& of,
                                   double error) {
        Bernstein<9, Real50> exact;
        std::copy(of.begin(), of.end(), exact.coefficients.begin());
        exact = exact.restricted(Real50(begin), Real50(end));
        double worst = 0;
        for (std::size_t j = 0; j <= 9; ++j)
          worst = std::max(worst, std::abs(to_double(Real50(found[j] - exact.coefficients[j]))));
        EXPECT_LE(0x1p-60 + worst, error);
        EXPECT_GT(worst, 0);
      };
      expect_near(half.x, piece.x, half.x_error);
      expect_near(half.clear, piece.clear, half.clear_error);
    };
    expect_half(halved.first, 0, 0.5);
    expect_half(halved.second, 0.5, 1);
  }
}

TEST(PieceIntegral, DeepPiecesAreHalvedAndWhatIsHiddenIsBounded) {
  for (const double depth : {100.0, 1e3, 1e5, 1e9}) {
    LinearPiece<3> piece{.x = {0, 0, 0, 0}, .extinction_at_0 = depth, .length = 1};
    const auto integral = integrate(piece, Emission::associated);
    EXPECT_NEAR(integral.weight_0, 1, integral.weight_error);
    EXPECT_LE(integral.weight_error, 1e-13);
    EXPECT_NEAR(integral.depth, depth, integral.depth_error);
    const auto plain = integrate(piece, Emission::plain);
    EXPECT_NEAR(plain.weight_0, 1 / depth, plain.weight_error);
    EXPECT_LE(plain.weight_error, 1e-13 / depth);
  }
}

// tau = depth x: weight_1 = integral of T less T(1), sqrt(pi / (2 depth)) at such depths, and weight_0 the rest of the
// opacity, 1. Positions are known to 10^-14, of which depth^(1/2) enters; beyond what can be told the bound says so.
TEST(PieceIntegral, DeepRampsEndAtAnyDepth) {
  for (const double depth : {1e4, 1e8, 1e12, 1e20, 1e100, 1e300}) {
    const LinearPiece<3> piece{.x = {0, 1.0 / 3, 2.0 / 3, 1}, .extinction_at_1 = depth, .length = 1};
    const double exact = std::sqrt(std::acos(-1.0) / (2 * depth));
    for (const auto& integral :
         {integrate(piece, Emission::associated), integrate_scalar(piece, Emission::associated)}) {
      EXPECT_NEAR(integral.weight_1, exact, integral.weight_error + 1e-15 * exact) << depth;
      EXPECT_NEAR(integral.weight_0, 1 - exact, integral.weight_error + 1e-16) << depth;
      EXPECT_LE(integral.weight_error, depth <= 1e12 ? 1e-14 * std::sqrt(depth) : HUGE_VAL) << depth;
    }
  }
}

TEST(Kernels, EightSideBySideEncloseToo) {
  LinearPiece<3, Eight> pieces;
  std::array<LinearPiece<3>, lane_count> singly;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    singly[lane] = random_piece<3>(lane, std::pow(10, static_cast<double>(lane) - 3));  // the last ones are halved
    for (std::size_t j = 0; j <= 3; ++j) pieces.x[j][lane] = singly[lane].x[j];
    pieces.extinction_at_0[lane] = singly[lane].extinction_at_0;
    pieces.extinction_at_1[lane] = singly[lane].extinction_at_1;
    pieces.length[lane] = 1;
  }
  const auto together = integrate(pieces, Emission::associated);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const auto alone = integrate(singly[lane], Emission::associated);
    EXPECT_NEAR(together.weight_0[lane], alone.weight_0, together.weight_error[lane] + alone.weight_error);
    EXPECT_NEAR(together.weight_1[lane], alone.weight_1, together.weight_error[lane] + alone.weight_error);
  }
}

template <int Degree>
void expect_agreeing_levels() {
  LinearPiece<Degree, Eight> pieces;
  Stretches<Degree> stretches;
  std::array<double, Degree + 1> rising;
  for (std::size_t j = 0; j <= Degree; ++j) {
    rising[j] = static_cast<double>(j) + uniform(40, j);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      pieces.x[j][lane] = uniform(20 + j, lane);
      stretches.signal[j][lane] = uniform(30 + j, lane);
    }
  }
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    pieces.extinction_at_0[lane] = 3 * uniform(50, lane);
    pieces.extinction_at_1[lane] = 5 * uniform(51, lane);
    pieces.length[lane] = stretches.scale[lane] = 1;
    stretches.begin[lane] = 0.4 * uniform(52, lane);
    stretches.end[lane] = 0.5 + 0.4 * uniform(53, lane);
  }
  const std::array targets{rising.front() + 0.1, rising.front() + 0.5, rising.back() - 0.1};
  const auto& best = kernels<Degree>();
  std::array<double, 3> abscissae{};
  best.crossings(rising, 0, 1, targets.data(), targets.size(), true, abscissae.data());
  for (std::size_t i = 0; i < targets.size(); ++i)
    EXPECT_NEAR((Bernstein<Degree>{rising}.value(abscissae[i])), targets[i], 1e-13);
  for (const Kernels<Degree>* version : kernel_versions<Degree>()) {
    const auto expected = best.integrate_eight(pieces, true);
    const auto integral = version->integrate_eight(pieces, true);
    const auto expected_stretches = best.normalise(stretches);
    const auto normalised = version->normalise(stretches);
    const Eight expected_transmittances = best.transmittances(pieces.extinction_at_0);
    const Eight transmittances = version->transmittances(pieces.extinction_at_0);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const double weight_error = integral.weight_error[lane] + expected.weight_error[lane];
      EXPECT_NEAR(integral.weight_0[lane], expected.weight_0[lane], weight_error);
      EXPECT_NEAR(integral.weight_1[lane], expected.weight_1[lane], weight_error);
      EXPECT_NEAR(integral.depth[lane], expected.depth[lane], integral.depth_error[lane] + expected.depth_error[lane]);
      for (std::size_t j = 0; j <= Degree; ++j)
        EXPECT_NEAR(normalised.x[j][lane], expected_stretches.x[j][lane],
                    normalised.x_error[lane] + expected_stretches.x_error[lane]);
      EXPECT_NEAR(transmittances[lane], expected_transmittances[lane],
                  2 * exponential_error * expected_transmittances[lane]);
    }
    std::array<double, 3> again{};
    version->crossings(rising, 0, 1, targets.data(), targets.size(), true, again.data());
    for (std::size_t i = 0; i < targets.size(); ++i) EXPECT_NEAR(again[i], abscissae[i], 1e-13);
  }
}

TEST(Kernels, EveryLevelOfTheProcessorEncloses) {
  expect_agreeing_levels<3>();
  expect_agreeing_levels<9>();
}

/// Eight cubics in [0, 1], or at its ends, whose largest extinction times their length is `depth`.
LinearPiece<3, Eight> random_cells(std::uint64_t index, double depth, bool extreme) {
  LinearPiece<3, Eight> cells;
  cells.length.fill(1);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const auto number = [&](std::uint64_t stream) {
      const double u = uniform(stream, lane_count * index + lane);
      return extreme ? std::round(u) : u;
    };
    for (std::size_t j = 0; j <= 3; ++j) cells.x[j][lane] = number(80 + j);
    cells.extinction_at_0[lane] = number(84);
    cells.extinction_at_1[lane] = number(85);
    const double largest = std::max(cells.extinction_at_0[lane], cells.extinction_at_1[lane]);
    const double scale = largest > 0 ? depth / largest : 0;
    cells.extinction_at_0[lane] *= scale;
    cells.extinction_at_1[lane] *= scale;
  }
  return cells;
}

TEST(CellKernels, RulesMissNoMoreThanTheyClaim) {
  double worst = 0;
  for (const CellRule& rule : {thin_cell, thick_cell})
    for (const Emission emission : {Emission::associated, Emission::plain})
      for (std::uint64_t i = 0; i < 400; ++i) {
        const auto cells = random_cells(i, rule.deepest * std::pow(0.5, static_cast<double>(i % 3)), i % 2 == 0);
        const auto certified = integrate(cells, emission);
        for (const CellKernels* version : cell_kernel_versions()) {
          const CellLight light = version->integrate(cells, emission == Emission::associated, rule.nodes);
          for (std::size_t lane = 0; lane < lane_count; ++lane) {
            const double sum = certified.weight_0[lane] + certified.weight_1[lane];
            const double missed = std::max(std::abs(light.weight_0[lane] - certified.weight_0[lane]),
                                           std::abs(light.weight_1[lane] - certified.weight_1[lane]));
            EXPECT_LE(missed, 0x1p-22 * sum);
            EXPECT_NEAR(light.opacity[lane], -std::expm1(-certified.depth[lane]), 1e-14);
            if (sum > 0) worst = std::max(worst, missed / sum);
          }
        }
      }
  EXPECT_GT(worst, 0x1p-26);  // fewer nodes would not do
}

/// Coefficients of x on [begin, end] in 50 digits.
TEST(Kernels, NormalisedStretchesAreWithinTheirError) {
  constexpr int degree = 3;
  Stretches<degree> stretches;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    for (std::size_t j = 0; j <= degree; ++j) stretches.signal[j][lane] = uniform(60 + j, lane);
    stretches.begin[lane] = 0.9 * uniform(70, lane);
    stretches.end[lane] = stretches.begin[lane] + std::pow(0.1, static_cast<double>(lane)) / 16;
    stretches.origin[lane] = uniform(71, lane);
    stretches.scale[lane] = std::pow(4.0, static_cast<double>(lane));
  }
  const auto normalised = kernels<degree>().normalise(stretches);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    Bernstein<degree, Real50> signal;
    for (std::size_t j = 0; j <= degree; ++j)
      signal.coefficients[j] =
          Real50(stretches.scale[lane]) * (Real50(stretches.signal[j][lane]) - Real50(stretches.origin[lane]));
    const auto exact = signal.restricted(Real50(stretches.begin[lane]), Real50(stretches.end[lane]));
    for (std::size_t j = 0; j <= degree; ++j)
      EXPECT_LE(abs(Real50(Real50(normalised.x[j][lane]) - exact.coefficients[j])), normalised.x_error[lane]);
    // The error shrinks with the stretch, down to the rounding of x itself.
    EXPECT_LE(normalised.x_error[lane], 1e-14 * (1 + std::abs(normalised.x[0][lane])));
  }
}

}  // namespace
}  // namespace raytruth
