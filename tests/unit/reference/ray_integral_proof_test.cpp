#include "raytruth/core/random.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/integral_cases.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>

// The reference's radius holds, by paths that share nothing with it: Arb, closed forms, a march in 50 digits, rays cut
// in parts, relations between rays. The experiment `reference_proof` asks Arb for longer.
namespace raytruth {
namespace {

constexpr std::uint64_t seed = 4;

constexpr auto integral = [](const auto& signal, const PiecewiseLinear& transfer, Emission emission) {
  return RayIntegral(transfer, emission)(signal);
};

Certified reference(const IntegralCase& asked, Emission emission) {
  return std::visit([&](const auto& signal) { return integral(signal, asked.transfer, emission); }, asked.signal);
}

Certified arb(const IntegralCase& asked, Emission emission) {
  return std::visit([&](const auto& signal) { return arb_integral(signal, asked.transfer, emission); }, asked.signal);
}

std::string text(const Certified& answer) {
  std::ostringstream stream;
  stream.precision(17);
  stream << answer.color.transpose() << ", opacity " << answer.opacity << " +- " << answer.radius;
  return stream.str();
}

void expect_agreement(const Certified& a, const Certified& b) {
  EXPECT_LE(difference_in_radii(a, b), 1) << text(a) << "\n" << text(b);
}

const char* name(Emission emission) { return emission == Emission::associated ? "associated" : "plain"; }

class ReferenceProof : public testing::TestWithParam<std::tuple<int, int>> {};

/// Whether the largest optical depth that the transfer function allows is no more than 30.
bool is_ordinary(const IntegralCase& asked) {
  double largest = 0;
  for (const TransferPoint& point : asked.transfer.points()) largest = std::max(largest, point.optics.extinction);
  return largest * std::visit([](const auto& signal) { return signal.length(); }, asked.signal) <= 30;
}

/// The order of the answer's values: of the opacity, or of the light that could be sent out.
double scale_of(const IntegralCase& asked, Emission emission) {
  double largest = 0;
  for (const TransferPoint& point : asked.transfer.points()) largest = std::max(largest, point.optics.color.maxCoeff());
  const double length = std::visit([](const auto& signal) { return signal.length(); }, asked.signal);
  return std::max(1.0, emission == Emission::plain ? largest * length : largest);
}

TEST_P(ReferenceProof, AgreesWithArb) {
  const auto [signal, transfer] = GetParam();
  const auto shape = static_cast<SignalShape>(signal);
  constexpr std::uint64_t cases = 32;
  // On which side of a jump these signals are, for how long, no rounded arithmetic decides.
  const bool may_be_undecided = shape == SignalShape::tangent || shape == SignalShape::level;
  for (std::uint64_t index = 0; index < cases; ++index) {
    const IntegralCase asked = random_case(shape, static_cast<TransferShape>(transfer), seed, index);
    for (const Emission emission : both_emissions) {
      SCOPED_TRACE(testing::Message() << "case " << index << " of seed " << seed << ", " << name(emission));
      const Certified here = reference(asked, emission);
      const Certified there = arb(asked, emission);
      expect_agreement(here, there);
      if (may_be_undecided || !is_ordinary(asked)) continue;
      // A table magnifies the rounding of the scalar by the number of its points.
      const double most = static_cast<TransferShape>(transfer) == TransferShape::table ? 2e-13 : 1e-13;
      EXPECT_LE(here.radius, most * scale_of(asked, emission)) << text(here);
      if (emission == Emission::associated && there.opacity > 1e-12 && there.opacity < 1e-6) {
        EXPECT_LE(here.radius, 2e-12 * there.opacity) << text(here);
      }
    }
  }
}

std::string case_name(const testing::TestParamInfo<ReferenceProof::ParamType>& info) {
  const auto [signal, transfer] = info.param;
  return std::string(signal_shapes[static_cast<std::size_t>(signal)]) + "_" +
         std::string(transfer_shapes[static_cast<std::size_t>(transfer)]);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ReferenceProof,
                         testing::Combine(testing::Range(0, static_cast<int>(signal_shapes.size())),
                                          testing::Range(0, static_cast<int>(transfer_shapes.size()))),
                         case_name);

TEST(RayIntegralProof, SmoothPieces) {
  for (std::uint64_t index = 0; index < 1000; ++index) {
    const IntegralCase asked = smooth_piece(seed, index);
    for (const Emission emission : both_emissions) {
      SCOPED_TRACE(testing::Message() << "smooth piece " << index << " of seed " << seed << ", " << name(emission));
      const Certified here = reference(asked, emission);
      expect_agreement(here, arb(asked, emission));
      EXPECT_LE(here.radius, 1e-13) << text(here);
    }
  }
}

TEST(RayIntegralProof, SmoothOpacityPieces) {
  for (std::uint64_t index = 0; index < 500; ++index) {
    const IntegralCase asked = smooth_opacity_piece(seed, index);
    for (const Emission emission : both_emissions) {
      SCOPED_TRACE(testing::Message() << "opacity piece " << index << " of seed " << seed << ", " << name(emission));
      const Certified here = reference(asked, emission);
      expect_agreement(here, arb(asked, emission));
      EXPECT_LE(here.radius, 5e-13) << text(here);
    }
  }
}

/// A ray that touches what is opaque, or does not, by less than a rounding, and then meets it in another colour; and one
/// that comes into it along a tangent: what it would have emitted until then is in doubt, not a difference of colours.
TEST(RayIntegralProof, ContactsWithWhatIsOpaque) {
  for (const std::uint64_t index : {178U, 196U}) {
    const IntegralCase asked = random_opacity_case(SignalShape::tangent, OpacityShape::opaque, 1, index);
    for (const Emission emission : both_emissions) {
      SCOPED_TRACE(testing::Message() << "case " << index << ", " << name(emission));
      expect_agreement(reference(asked, emission), arb(asked, emission));
    }
  }
}

/// The comparison itself can fail.
TEST(RayIntegralProof, SeesASmallMistake) {
  const IntegralCase asked = smooth_piece(seed, 0);
  auto points = asked.transfer.points();
  for (TransferPoint& point : points) point.optics.extinction *= 1 + 1e-12;
  const IntegralCase other{asked.signal, PiecewiseLinear(points)};
  EXPECT_GT(difference_in_radii(reference(asked, Emission::associated), arb(other, Emission::associated)), 1);
}

/// Four numbers in [0, 1) for every i.
std::array<double, 4> noise(std::uint64_t i) { return random_numbers(seed, RandomStream::points, i); }

/// A continuous chain of cubics, as through a volume of white noise.
Chain<3> noisy_ray(int pieces) {
  Chain<3> chain;
  double before = 0.5;
  for (int i = 0; i < pieces; ++i) {
    const auto [a, b, c, length] = noise(static_cast<std::uint64_t>(i));
    chain.pieces.push_back({chain.end, length, {{before, a, b, c}}});
    chain.end = chain.end + length;
    before = c;
  }
  return chain;
}

PiecewiseLinear noisy_transfer(double extinction) {
  std::vector<TransferPoint> points;
  for (int i = 0; i <= 8; ++i) {
    const auto [tau, r, g, b] = random_numbers(seed, RandomStream::transfers, static_cast<std::uint64_t>(i));
    points.push_back({i / 8.0, {extinction * tau, {r, g, b}}});
  }
  return PiecewiseLinear(points);
}

TEST(RayIntegralProof, TenThousandPieces) {
  const Chain<3> signal = noisy_ray(10'000);
  const PiecewiseLinear ramp({{0, {0, {0, 0.5, 1}}}, {1, {4 / signal.length(), {1, 0.25, 0}}}});
  for (const Emission emission : both_emissions) {
    const Certified here = integral(signal, ramp, emission);
    expect_agreement(here, arb_integral(signal, ramp, emission));
    EXPECT_EQ(here.status, Status::converged) << text(here);
  }
}

/// Pieces first ... last - 1 as a ray of their own.
template <int Degree>
Chain<Degree> part(const Chain<Degree>& whole, std::size_t first, std::size_t last) {
  Chain<Degree> result;
  const DoubleDouble begin = whole.pieces[first].start;
  for (std::size_t i = first; i < last; ++i) {
    result.pieces.push_back(whole.pieces[i]);
    result.pieces.back().start = whole.pieces[i].start - begin;
  }
  result.end = whole.end_of(last - 1) - begin;
  return result;
}

/// C = C_f + T_f C_b, T = T_f T_b: the errors of both sides add up.
TEST(RayIntegralProof, PartsComposeToTheWhole) {
  const Chain<3> whole = noisy_ray(12);
  for (const Emission emission : both_emissions)
    for (const double extinction : {1e-6, 0.5, 20.0}) {
      const PiecewiseLinear transfer = noisy_transfer(extinction);
      const Certified together = integral(whole, transfer, emission);
      for (std::size_t cut = 1; cut < whole.pieces.size(); ++cut) {
        const Certified front = integral(part(whole, 0, cut), transfer, emission);
        const Certified back = integral(part(whole, cut, whole.pieces.size()), transfer, emission);
        const double clear = 1 - front.opacity;
        const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::max(1.0, together.color.maxCoeff());
        const double radius = together.radius + front.radius * (1 + back.color.maxCoeff()) + back.radius + rounding;
        EXPECT_NEAR(together.opacity, front.opacity + clear * back.opacity, radius);
        for (Eigen::Index i = 0; i < 3; ++i)
          EXPECT_NEAR(together.color[i], front.color[i] + clear * back.color[i], radius);
      }
    }
}

TEST(RayIntegralProof, OpacityIsTheSameFromBehind) {
  const Chain<3> signal = noisy_ray(20);
  Chain<3> reversed = signal;
  std::reverse(reversed.pieces.begin(), reversed.pieces.end());
  reversed.end = 0;
  for (auto& piece : reversed.pieces) {
    std::reverse(piece.polynomial.coefficients.begin(), piece.polynomial.coefficients.end());
    piece.start = reversed.end;
    reversed.end += piece.length;
  }
  for (const double extinction : {1e-9, 1e-3, 0.5, 20.0}) {
    const PiecewiseLinear transfer = noisy_transfer(extinction);
    const Certified there = integral(signal, transfer, Emission::associated);
    const Certified back = integral(reversed, transfer, Emission::associated);
    EXPECT_LE(std::abs(there.opacity - back.opacity), there.radius + back.radius);
  }
}

/// Length times 2^k and extinction by 2^k change no bit of opacity and associated colour, and scale plain colour by
/// 2^k.
TEST(RayIntegralProof, UnitsOfLengthChangeNothing) {
  const Chain<3> signal = noisy_ray(10);
  for (const int k : {-40, -3, 1, 30})
    for (const Emission emission : both_emissions) {
      Chain<3> scaled = signal;
      const double unit = std::ldexp(1, k);
      for (auto& piece : scaled.pieces) {
        piece.start = piece.start * unit;
        piece.length *= unit;
      }
      scaled.end = scaled.end * unit;
      const Certified here = integral(signal, noisy_transfer(2), emission);
      Certified there = integral(scaled, noisy_transfer(2 / unit), emission);
      if (emission == Emission::plain) there.color /= unit;
      EXPECT_EQ(here.opacity, there.opacity) << k << name(emission);
      EXPECT_TRUE((here.color == there.color).all()) << k << name(emission) << text(here) << "\n" << text(there);
    }
}

TEST(RayIntegralProof, APointOnALineChangesNothing) {
  const Chain<3> signal = noisy_ray(10);
  const TransferPoint a{0.25, {2, {0.5, 0.25, 0}}};
  const TransferPoint b{0.75, {6, {1, 0.75, 0.5}}};
  const TransferPoint between{0.5, {4, {0.75, 0.5, 0.25}}};
  for (const Emission emission : both_emissions)
    expect_agreement(integral(signal, PiecewiseLinear({a, b}), emission),
                     integral(signal, PiecewiseLinear({a, between, b}), emission));
}

constexpr double precision = 1e-13;

/// The light of either end of a transfer function's interval is known to some roundings of all that could be sent out.
TEST(RayIntegralProof, ConstantSignals) { expect_constant_signals(integral, precision, 1e-14); }
TEST(RayIntegralProof, ConstantSignalsAtAPointTakeItsRightHandValue) { expect_right_hand_values(integral, precision); }
/// Up to a depth of 375: every halving of a deep piece rounds once more.
TEST(RayIntegralProof, LinearSignalsUnderALinearExtinction) {
  const auto deep_integral = [](const auto& signal, const PiecewiseLinear& transfer, Emission emission) {
    return RayIntegral(transfer, emission)(signal, {}, 2 * precision);
  };
  expect_linear_signals(deep_integral, 2 * precision);
}

TEST(RayIntegralProof, AStepInTheTransferFunction) { expect_step(integral, precision); }
TEST(RayIntegralProof, PolynomialsAgainstAMarchOf50Digits) { expect_march(integral, precision); }

}  // namespace
}  // namespace raytruth
