// The prelude as a compiler makes it that may reassociate sums, as those of WGSL, Metal and old GLSL may. This file is
// compiled so, with literals of single precision and as GLSL ES 3.00, which has no `precise` (see tests/CMakeLists.txt).
// What is lost is what shader_text.cpp and rules/README.md say.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace raytruth {
namespace {

namespace reassociated {

using uint = std::uint32_t;

float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }
uint floatBitsToUint(float x) { return std::bit_cast<uint>(x); }
float max(float a, float b) { return a < b ? b : a; }
float min(float a, float b) { return b < a ? b : a; }
float floor(float x) { return std::floor(x); }
float sqrt(float x) { return std::sqrt(x); }
float abs(float x) { return std::abs(x); }

#include "raytruth/rules/prelude.glsl"
#undef real
#undef as_written

}  // namespace reassociated

struct Error {
  double ulps = 0;
  double absolute = 0;
};

/// The largest error of an approximation between two places, in units in the last place and as it is.
template <class Function, class Truth>
Error largest_error(Function function, Truth truth, double low, double high) {
  constexpr int count = 400000;
  Error largest;
  for (int i = 0; i <= count; ++i) {
    const auto x = static_cast<float>(low + (high - low) * i / count);
    const double exact = truth(static_cast<double>(x));
    const double error = std::abs(static_cast<double>(function(x)) - exact);
    largest.absolute = std::max(largest.absolute, error);
    if (exact != 0) largest.ulps = std::max(largest.ulps, std::ldexp(error, 23 - std::ilogb(exact)));
  }
  return largest;
}

Error logarithm_error(double low, double high) {
  return largest_error(
      reassociated::log1p, [](double x) { return std::log1p(x); }, low, high);
}

Error exponential_error(double low, double high) {
  return largest_error(
      reassociated::expm1, [](double x) { return std::expm1(x); }, low, high);
}

TEST(ReassociatedPrelude, LogarithmKeepsItsDigits) {
  for (const auto& [low, high] :
       {std::pair(-0.9999999, -0.99), {-0.99, -0.29}, {-0.29, 0.0}, {1e-9, 0.41}, {0.41, 4.0}, {4.0, 1e6}})
    EXPECT_LE(logarithm_error(low, high).ulps, 3) << low << ' ' << high;
  EXPECT_GT(logarithm_error(0.41, 0.5).ulps, 1) << "nothing was reassociated: this test has lost its flags";
}

TEST(ReassociatedPrelude, ExponentialKeepsItsDigitsBelowOne) {
  EXPECT_LE(exponential_error(-80, 1).ulps, 4);
  EXPECT_LE(exponential_error(1, 80).ulps, 80);
}

TEST(ReassociatedPrelude, AnglesKeepTheirAbsoluteErrors) {
  EXPECT_LE(largest_error(
                reassociated::sine, [](double x) { return std::sin(x); }, 0, 3.1415926)
                .absolute,
            0x1p-22);
  EXPECT_LE(largest_error(
                reassociated::arc_cosine, [](double x) { return std::acos(x); }, -1, 1)
                .absolute,
            0x1p-21);
  EXPECT_LE(
      largest_error([](float x) { return reassociated::power(x, 20); }, [](double x) { return std::pow(x, 20); }, 0, 1)
          .absolute,
      0x1p-21);
}

}  // namespace
}  // namespace raytruth
