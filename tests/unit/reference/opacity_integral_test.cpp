#include "raytruth/core/real50.hpp"
#include "raytruth/kernels/depth_table.hpp"
#include "raytruth/kernels/exponential.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/integral_cases.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>

// Transfer functions that are linear in opacity, certified: against closed forms, against Arb, against the function
// that many linear pieces of extinction make of them.
namespace raytruth {
namespace {

const Vector3<double> red{1, 0.25, 0};
const Vector3<double> blue{0, 0.5, 1};

Certified certify(const Chain<9>& signal, const PiecewiseLinear& transfer, Emission emission) {
  return RayIntegral(transfer, emission)(signal);
}

/// The mean of -ln(1 - a) for a linear from 0 to `most`: with F(x) = (1 - x) ln(1 - x) - (1 - x) it is (F(most) - F(0))
/// / most.
double mean_depth(double most) {
  const Real50 rest = 1 - Real50(most);
  return to_double(Real50(((rest > 0 ? Real50(rest * log(rest)) : Real50(0)) - rest + 1) / Real50(most)));
}

TEST(OpacityIntegral, OfARampIsTheClosedForm) {
  const Chain<9> line = piecewise_polynomial({0, 1}, {{0, 1}});
  for (const double most : {1e-9, 0.01, 0.5, 0.9, 0.99, 1 - 0x1p-12, 1.0}) {
    const PiecewiseLinear transfer = from_opacity({{0, 0, red}, {1, most, blue}}, 1);
    for (const Emission emission : both_emissions) {
      SCOPED_TRACE(most);
      const Certified answer = certify(line, transfer, emission);
      EXPECT_EQ(answer.status, Status::converged);
      EXPECT_LE(answer.radius, 1e-13);
      EXPECT_NEAR(answer.opacity, -std::expm1(-mean_depth(most)), answer.radius + 1e-16);
      EXPECT_LE(difference_in_radii(answer, arb_integral(line, transfer, emission)), 1);
    }
  }
  // The number that 1024 linear pieces of extinction got wrong in the tenth digit.
  const Certified answer = certify(line, from_opacity({{0, 0, red}, {1, 0.99, blue}}, 1), Emission::associated);
  EXPECT_NEAR(answer.opacity, 0.6146037023, 5e-11);
}

/// 1 - a = t^n: the depth of a contact of order n is n over the unit of length, here 2. Pairs of binary64 numbers tell
/// t to 2^(-94/n).
TEST(OpacityIntegral, OfAContactOfHighOrderIsFinite) {
  const PiecewiseLinear transfer = from_opacity({{0, 0, red}, {1, 1, blue}}, 2);
  for (const auto& [order, most] : {std::pair{1, 1e-13}, {2, 1e-11}, {4, 1e-4}, {6, 1e-2}, {8, 1e-1}}) {
    SCOPED_TRACE(order);
    std::vector<double> coefficients(static_cast<std::size_t>(order) + 1, 0.0);
    coefficients.front() = 1;
    coefficients.back() = -1;
    const Chain<9> chain = piecewise_polynomial({0, 1}, {coefficients});
    for (const Emission emission : both_emissions) {
      const Certified answer = certify(chain, transfer, emission);
      EXPECT_LE(answer.radius, most);
      EXPECT_NEAR(answer.opacity, -std::expm1(-0.5 * order), answer.radius + 1e-15);
      EXPECT_LE(difference_in_radii(answer, arb_integral(chain, transfer, emission)), 1);
    }
  }
}

TEST(OpacityIntegral, EndsWhereTheOpacityIsOneOnAStretch) {
  const Chain<9> line = piecewise_polynomial({0, 1}, {{0, 1}});
  // Opaque from s = 1/2 on, clear before, with a jump: nothing is seen but the colour there.
  const PiecewiseLinear wall = from_opacity({{0, 0, red}, {0.5, 0, red}, {0.5, 1, blue}, {1, 1, red}}, 1);
  const Certified associated = certify(line, wall, Emission::associated);
  EXPECT_EQ(associated.opacity, 1);
  EXPECT_LE(associated.radius, 1e-13);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(associated.color[i], blue[i], associated.radius);
  // Plain emission: the clear half shines, the wall does not.
  const Certified plain = certify(line, wall, Emission::plain);
  EXPECT_LE(plain.radius, 1e-13);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(plain.color[i], 0.5 * red[i], plain.radius);
  // A constant signal in the wall ends at once; and so does one at the single scalar of opacity 1.
  const PiecewiseLinear peak = from_opacity({{0, 0, red}, {0.5, 1, blue}, {1, 0, red}}, 1);
  for (const PiecewiseLinear& transfer : {wall, peak}) {
    const Certified here = certify(piecewise_polynomial({0, 3}, {{0.5}}), transfer, Emission::associated);
    EXPECT_EQ(here.opacity, 1);
    EXPECT_LE(here.radius, 1e-13);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(here.color[i], blue[i], here.radius);
  }
}

class OpacityProof : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(OpacityProof, AgreesWithArb) {
  const auto [signal, transfer] = GetParam();
  const auto shape = static_cast<SignalShape>(signal);
  const auto opacity = static_cast<OpacityShape>(transfer);
  constexpr std::uint64_t seed = 4;
  constexpr std::uint64_t cases = 4;
  const bool may_be_undecided = shape == SignalShape::tangent || shape == SignalShape::level;
  for (std::uint64_t index = 0; index < cases; ++index) {
    const IntegralCase asked = random_opacity_case(shape, opacity, seed, index);
    for (const Emission emission : both_emissions) {
      SCOPED_TRACE(testing::Message() << "case " << index << ", "
                                      << (emission == Emission::plain ? "plain" : "assoc."));
      std::visit(
          [&](const auto& chain) {
            const Certified here = RayIntegral(asked.transfer, emission)(chain);
            const Certified there = arb_integral(chain, asked.transfer, emission);
            EXPECT_LE(difference_in_radii(here, there), 1) << here.rgba().transpose() << " +- " << here.radius << "\n"
                                                           << there.rgba().transpose() << " +- " << there.radius;
            if (may_be_undecided) return;
            // An opacity of 0.99 magnifies the rounding of the scalar by 100, which degree 9 has more of.
            const double scale = emission == Emission::plain ? std::max(1.0, chain.length()) : 1;
            EXPECT_LE(here.radius, (chain.pieces.front().polynomial.degree == 3 ? 1e-13 : 5e-13) * scale);
          },
          asked.signal);
    }
  }
}

std::string case_name(const testing::TestParamInfo<OpacityProof::ParamType>& info) {
  const auto [signal, transfer] = info.param;
  return std::string(signal_shapes[static_cast<std::size_t>(signal)]) + "_" +
         std::string(opacity_shapes[static_cast<std::size_t>(transfer)]);
}

INSTANTIATE_TEST_SUITE_P(Shapes, OpacityProof,
                         testing::Combine(testing::Range(0, static_cast<int>(signal_shapes.size())),
                                          testing::Range(0, static_cast<int>(opacity_shapes.size()))),
                         case_name);

/// Against one more path: the same function as 2^16 linear pieces of extinction, to what they leave out.
TEST(OpacityIntegral, IsTheLimitOfLinearPieces) {
  const Chain<9> signal = piecewise_polynomial({0, 1.5}, {{0.1, 0.9, -0.35}});
  const PiecewiseLinear transfer = from_opacity({{0, 0.1, red}, {0.4, 0.8, blue}, {1, 0.3, red}}, 0.7);
  for (const Emission emission : both_emissions) {
    const Certified exact = certify(signal, transfer, emission);
    const Certified linear = certify(signal, linear_in_extinction(transfer), emission);
    EXPECT_NEAR(exact.opacity, linear.opacity, 1e-6);
    EXPECT_NE(exact.opacity, linear.opacity);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(exact.color[i], linear.color[i], 1e-6);
  }
}

TEST(Logarithm, ErrsByLessThanItsBound) {
  double largest = 0;
  for (int i = 1; i < 40000; ++i) {
    // Opacities near 0, near 1 and between.
    const double x = i / 40000.0;
    for (const double opacity : {x, std::exp2(-60 * x), 1 - std::exp2(-53 * x)}) {
      const double clear = 1 - opacity;
      if (clear <= 0 || 1 - clear != opacity) continue;
      const Real50 exact = -log1p(Real50(-opacity));
      const double found = minus_log(opacity, clear);
      largest = std::max(largest, to_double(Real50(abs(found - exact) / exact)));
    }
  }
  EXPECT_LE(largest, minus_log_error);
  EXPECT_GE(largest, unit_roundoff / 2);
}

TEST(DepthTable, IntegratesPolynomials) {
  for (std::size_t samples = 0; samples < depth_sample_counts.size(); ++samples) {
    const auto& table = depth_table<3>(samples, 3);
    const std::size_t degree = 7;
    for (std::size_t row = 0; row <= table.node_count; ++row) {
      const double u = row < table.node_count ? table.nodes->nodes[row] : 1;
      double sum = 0;
      for (std::size_t j = 0; j < table.sample_count; ++j) {
        const double place =
            (1 - std::cos(M_PI * static_cast<double>(2 * j + 1) / (2.0 * static_cast<double>(table.sample_count)))) / 2;
        sum += table.integrals[row][j] * std::pow(place, degree);
      }
      EXPECT_NEAR(sum, std::pow(u, degree + 1) / (degree + 1), 1e-15) << samples << ", " << row;
    }
    EXPECT_LE(table.largest_row, 1.5);
  }
}

}  // namespace
}  // namespace raytruth
