#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/shading/gooch.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/transfer/emission.hpp"
#include "unit/support/random_slabs.hpp"
#include "unit/support/real50_integral.hpp"

#include <gtest/gtest.h>
#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace raytruth {
namespace {

Vector3<double> direction(double degrees, double tilt_degrees = 0) {
  const double angle = degrees * std::numbers::pi / 180;
  const double tilt = tilt_degrees * std::numbers::pi / 180;
  return {std::sin(angle) * std::cos(tilt), std::sin(tilt), std::cos(angle) * std::cos(tilt)};
}

PiecewiseLinear constant_transfer(double extinction) { return PiecewiseLinear({{0.5, {extinction, {1, 0.5, 0.25}}}}); }

Lighting lighting_from(const Vector3<double>& light, const Vector3<double>& half) {
  Lighting lighting;
  lighting.light = light;
  lighting.half = half;
  lighting.ambient = 0.25;
  lighting.specular = 0.5;
  return lighting;
}

void expect_within(double value, double truth, double radius, const std::string& what) {
  EXPECT_LE(std::abs(value - truth), radius) << what << ": " << value << " against " << truth;
}

// --- The same integrals in 50 digits, by other means: Gauss' rule between knots found on a grid ---

struct Slab50 {
  const ShadedSlab& slab;
  const PiecewiseLinear& transfer;
  const Lighting& lighting;

  [[nodiscard]] Real50 cosine(const Vector3<double>& vector, const Real50& x) const {
    std::array<Real50, 3> normal;
    Real50 square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      normal[i] = (1 - x) * slab.front_normal[k] + x * Real50(slab.back_normal[k]);
      square += normal[i] * normal[i];
    }
    return (normal[0] * vector[0] + normal[1] * vector[1] + normal[2] * vector[2]) / sqrt(square);
  }
  [[nodiscard]] Real50 treated(const Real50& cosine) const {
    if (lighting.negative == Negative::clamp) return cosine > 0 ? cosine : Real50(0);
    return lighting.negative == Negative::mirror ? Real50(abs(cosine)) : cosine;
  }
  [[nodiscard]] Real50 highlight(const Real50& cosine) const {
    const Real50 c = treated(cosine);
    if (lighting.is_lobe()) {
      if (c == 0) return 0;
      const Real50 power = pow(Real50(abs(c)), Real50(lighting.shininess));
      return c < 0 && std::fmod(lighting.shininess, 2) == 1 ? Real50(-power) : power;
    }
    const int q = lighting.highlight->degree;
    const Real50 base = 1 + exponent() / q * (c - 1);
    return base > 0 ? Real50(pow(base, q)) : Real50(0);
  }
  /// (n + 1)/2 of the cone of equal energy; minimax members are what binary64 makes of them.
  [[nodiscard]] Real50 exponent() const {
    if (lighting.highlight->name == "cone_energy") return (Real50(lighting.shininess) + 1) / 2;
    const bool is_minimax = lighting.highlight->name.ends_with("minimax");
    return is_minimax ? lighting.highlight->exponent(lighting.shininess) : lighting.shininess;
  }
  [[nodiscard]] Real50 scalar(const Real50& x) const { return slab.front + x * (Real50(slab.back) - slab.front); }

  template <class Function>
  void add_changes(const Function& f, std::vector<Real50>& knots) const {
    constexpr int grid = 200;
    for (int i = 0; i < grid; ++i) {
      Real50 low = Real50(i) / grid;
      Real50 high = Real50(i + 1) / grid;
      const bool rises = f(high) > 0;
      if ((f(low) > 0) == rises) continue;
      for (int halving = 0; halving < 160; ++halving) {
        const Real50 middle = (low + high) / 2;
        ((f(middle) > 0) == rises ? high : low) = middle;
      }
      knots.push_back(low);
    }
  }

  [[nodiscard]] std::vector<Real50> knots() const {
    std::vector<Real50> result;
    constexpr int panels = 16;  // that resolve lobes of shininess 80 to 30 digits and more
    for (int i = 0; i <= panels; ++i) result.push_back(Real50(i) / panels);
    for (const TransferPoint& point : transfer.points())
      add_changes([&](const Real50& x) { return Real50(scalar(x) - point.s); }, result);
    add_changes([&](const Real50& x) { return cosine(lighting.light, x); }, result);
    add_changes([&](const Real50& x) { return cosine(lighting.half, x); }, result);
    if (!lighting.is_lobe()) {
      const Real50 threshold = 1 - lighting.highlight->degree / exponent();
      for (const int sign : {-1, 1})
        add_changes([&](const Real50& x) { return Real50(cosine(lighting.half, x) - sign * threshold); }, result);
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  /// ambient, diffuse (three channels each), specular, opacity.
  [[nodiscard]] std::array<Real50, 8> integrals(Emission emission) const {
    std::array<Real50, 8> sums{};
    Real50 depth = 0;
    const auto all = knots();
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      // The extinction is linear in between: its values at two inner points say all, jumps at the ends do not matter.
      const Real50 width = all[i + 1] - all[i];
      if (width < 1e-40) continue;
      const auto at = [&](int quarter) { return all[i] + width * quarter / 4; };
      const Real50 slope = 2 * (extinction(at(3)) - extinction(at(1))) / width;
      const auto depth_at = [&](const Real50& x) {
        const Real50 begin = extinction(at(1)) - slope * width / 4;
        return Real50(depth + slab.length * (x - all[i]) * (begin + slope * (x - all[i]) / 2));
      };
      for_each_node(all[i], all[i + 1], [&](const Real50& x, const Real50& weight) {
        const Optics50 optics = interpolated(transfer, scalar(x));
        const Real50 white = emission == Emission::associated ? optics.extinction : Real50(1);
        const Real50 visible = weight * slab.length * white * exp(-depth_at(x));
        const Real50 lit = visible * treated(cosine(lighting.light, x));
        for (std::size_t k = 0; k < 3; ++k) {
          sums[k] += lighting.ambient * visible * optics.color[k];
          sums[3 + k] += lighting.diffuse * lit * optics.color[k];
        }
        sums[6] += lighting.specular * visible * highlight(cosine(lighting.half, x));
      });
      depth = depth_at(all[i + 1]);
    }
    sums[7] = -expm1(-depth);
    return sums;
  }

  [[nodiscard]] Real50 extinction(const Real50& x) const { return interpolated(transfer, scalar(x)).extinction; }
};

std::array<double, 8> numbers_of(const ShadedRadiance& light) {
  return {light.ambient[0], light.ambient[1], light.ambient[2],  light.diffuse[0],
          light.diffuse[1], light.diffuse[2], light.specular[0], light.opacity};
}

TEST(SlabReference, AgreesWith50Digits) {
  for (std::uint64_t index = 0; index < 60; ++index) {
    const auto [slab, lighting] = random_slab(7, index);
    const PiecewiseLinear& transfer = transfer_of(index % 4);
    for (const Emission emission : both_conventions) {
      const auto truth = Slab50{slab, transfer, lighting}.integrals(emission);
      const CertifiedRadiance certified = slab_reference(slab, transfer, emission, lighting);
      EXPECT_EQ(certified.status, Status::converged);
      EXPECT_LT(certified.radius, 2e-15);
      const auto found = numbers_of(certified);
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_LE(abs(truth[i] - found[i]), certified.radius)
            << "slab " << index << ", number " << i << ": " << found[i] << " against " << truth[i];
    }
  }
}

TEST(SlabReference, HomogeneousMatterUnderOneNormal) {
  const ShadedSlab slab{0.3, 0.7, 2, direction(40), direction(40)};
  Lighting lighting = lighting_from(direction(0), direction(20));
  const double c = std::cos(40 * std::numbers::pi / 180);
  const double h = std::pow(std::cos(20 * std::numbers::pi / 180), 20);
  for (const double extinction : {0.0, 1e-9, 1.5, 1e6})
    for (const Emission emission : both_conventions) {
      const double opacity = -std::expm1(-2 * extinction);
      const double light = emission == Emission::associated ? opacity : extinction > 0 ? opacity / extinction : 2;
      const auto found = slab_reference(slab, constant_transfer(extinction), emission, lighting);
      EXPECT_NEAR(found.ambient[0], 0.25 * light, 1e-15 * light);
      EXPECT_NEAR(found.diffuse[1], 0.5 * c * light, 1e-15 * light);
      EXPECT_NEAR(found.specular[2], 0.5 * h * light, 3e-15 * light);
      EXPECT_NEAR(found.opacity, opacity, 2e-16);
    }
}

TEST(SlabReference, RightAngleInClosedForm) {
  // N.L = (1-x) / sqrt((1-x)^2 + x^2): by symmetry half the integral of 1 / sqrt(2 (x - 1/2)^2 + 1/2).
  const ShadedSlab slab{0.5, 0.5, 1, {0, 0, 1}, {1, 0, 0}};
  const auto found = slab_reference(slab, constant_transfer(0), Emission::plain, lighting_from({0, 0, 1}, {0, 0, 1}));
  expect_within(found.diffuse[0], std::asinh(1.0) / std::numbers::sqrt2, 2e-16, "diffuse");
}

TEST(SlabReference, TreatmentsOfALightAcrossTheSlabInClosedForm) {
  // N.L = sin a x / sqrt(cos^2 a + x^2 sin^2 a), x from -1 to 1; half of it is lit, (1 - cos a) / (2 sin a).
  for (const double angle : {20.0, 90.0, 170.0, 179.9}) {
    const ShadedSlab slab{0.5, 0.5, 1, direction(-angle / 2), direction(angle / 2)};
    Lighting lighting = lighting_from({1, 0, 0}, {1, 0, 0});
    const double lit = std::tan(angle * std::numbers::pi / 720) / 2;
    for (const auto& [negative, expected] :
         {std::pair{Negative::clamp, lit}, {Negative::mirror, 2 * lit}, {Negative::none, 0.0}}) {
      lighting.negative = negative;
      const auto found = slab_reference(slab, constant_transfer(0), Emission::plain, lighting);
      expect_within(found.diffuse[0], expected, 1e-15, "diffuse");
      EXPECT_EQ(found.status, Status::converged) << angle << ", radius " << found.radius;
    }
  }
}

TEST(SlabReference, BackToFrontIsTheSameWithoutAbsorption) {
  const PiecewiseLinear transfer(
      {{0, {0, {0, 1, 0}}}, {0.5, {0, {1, 0, 1}}}, {0.5, {0, {0, 0, 0.5}}}, {1, {0, {1, 1, 1}}}});
  for (std::uint64_t index = 0; index < 20; ++index) {
    const auto [slab, lighting] = random_slab(7, index);
    const ShadedSlab reversed{slab.back, slab.front, slab.length, slab.back_normal, slab.front_normal};
    const auto a = slab_reference(slab, transfer, Emission::plain, lighting);
    const auto b = slab_reference(reversed, transfer, Emission::plain, lighting);
    for (std::size_t i = 0; i < 8; ++i)
      expect_within(numbers_of(a)[i], numbers_of(b)[i], a.radius + b.radius, "slab " + std::to_string(index));
  }
}

TEST(SlabReference, HardSlabs) {
  Lighting lighting = lighting_from(direction(180), direction(180));
  const ShadedSlab empty{0.2, 0.8, 0, direction(0), direction(60)};
  EXPECT_EQ(slab_reference(empty, ramp_transfer(3), Emission::plain, lighting).color().maxCoeff(), 0);
  EXPECT_EQ(slab_reference(empty, ramp_transfer(3), Emission::plain, lighting).opacity, 0);

  // A cosine of -1 all along.
  const ShadedSlab dark{0.2, 0.8, 1, direction(0), direction(0)};
  const auto clamped = slab_reference(dark, ramp_transfer(3), Emission::plain, lighting);
  EXPECT_LT(clamped.diffuse.maxCoeff() + clamped.specular.maxCoeff(), 1e-30);
  lighting.negative = Negative::mirror;
  const auto mirrored = slab_reference(dark, ramp_transfer(3), Emission::plain, lighting);
  expect_within(mirrored.diffuse[1], 4 * mirrored.ambient[1], 1e-15, "mirrored");

  // So deep that only the front is seen.
  lighting = lighting_from(direction(0), direction(0));
  const ShadedSlab deep{0.75, 0.25, 1e6, direction(60), direction(-60)};
  const auto front = slab_reference(deep, step_transfer(1e3), Emission::associated, lighting);
  EXPECT_EQ(front.opacity, 1);
  EXPECT_NEAR(front.diffuse[0], 0.75 * 0.5, 1e-8);
  EXPECT_EQ(front.status, Status::converged);

  // A jump at the very scalar of a slab: the value from the right counts.
  const ShadedSlab at_jump{0.5, 0.5, 1, direction(0), direction(0)};
  EXPECT_GT(slab_reference(at_jump, step_transfer(1), Emission::associated, lighting).opacity, 0.6);

  // Light in the plane that all normals of the slab stand upright on, but for rounding.
  const ShadedSlab across{0.2, 0.8, 1, direction(10), direction(70)};
  lighting.light = {0, 1, 0};
  EXPECT_LT(slab_reference(across, ramp_transfer(3), Emission::plain, lighting).diffuse.maxCoeff(), 1e-16);
  // And nearly so: a kink between values of some 1e-20.
  lighting.light = {1e-20, 1, 0};
  const auto faint =
      slab_reference({0.2, 0.8, 1, direction(-10), direction(70)}, ramp_transfer(3), Emission::plain, lighting);
  EXPECT_EQ(faint.status, Status::converged);
  EXPECT_GT(faint.diffuse[0], 0);
}

TEST(SlabReference, ConeThatIsTouchedOnly) {
  // The largest cosine is the threshold, to rounding: whatever rounding makes of it, next to nothing is lit.
  Lighting lighting = lighting_from(direction(0), direction(0, 60));
  lighting.highlight = find_named(catalogue::highlights(), "cone");
  lighting.shininess = 2;
  const ShadedSlab slab{0.2, 0.8, 1, direction(-45), direction(45)};
  const auto found = slab_reference(slab, ramp_transfer(3), Emission::plain, lighting);
  EXPECT_LT(std::abs(found.specular[0]), 1e-15);
  EXPECT_EQ(found.status, Status::converged);
}

TEST(SlabReference, VectorsPerpendicularToBothNormals) {
  // Exactly, in the plane of two axes, and to rounding, in a plane that lies askew.
  const double s = std::sin(0.7);
  const double c = std::cos(0.7);
  const auto askew = [&](const Vector3<double>& v) {
    const Vector3<double> tilted{v[0] * c - v[1] * s, v[0] * s + v[1] * c, v[2]};
    return Vector3<double>{tilted[0], tilted[1] * c - tilted[2] * s, tilted[1] * s + tilted[2] * c};
  };
  const PiecewiseLinear transfer = ramp_transfer(4);
  const auto& highlights = catalogue::highlights();
  std::size_t turn = 0;
  for (const double degrees : {0.0, 30.0, 45.0, 90.0, 150.0, 175.0})
    for (const bool is_askew : {false, true})
      for (const bool is_half : {false, true})
        for (const Negative negative : {Negative::clamp, Negative::mirror, Negative::none}) {
          const auto placed = [&](const Vector3<double>& v) { return is_askew ? askew(v) : v; };
          const double radians = degrees * std::numbers::pi / 180;
          const ShadedSlab slab{0.2, 0.7, 1, placed({0, 0, 1}), placed({0, std::sin(radians), std::cos(radians)})};
          Lighting lighting = lighting_from(placed({1, 0, 0}), placed({0, 0.6, 0.8}));
          if (is_half) std::swap(lighting.light, lighting.half);
          lighting.negative = negative;
          lighting.highlight = &highlights[turn % highlights.size()];
          lighting.shininess = std::array{1.0, 3.0, 20.0}[turn / 3 % 3];
          ++turn;
          const std::string what = std::to_string(degrees) + (is_askew ? " askew" : "") +
                                   (is_half ? " half, " : " light, ") + std::string(lighting.highlight->name);
          const auto found = slab_reference(slab, transfer, Emission::associated, lighting);
          EXPECT_LT(found.radius, 1e-15) << what;
          EXPECT_LE(is_half ? 0 : found.diffuse.abs().maxCoeff(), is_askew ? 1e-16 : 0) << what;
          const auto truth = Slab50{slab, transfer, lighting}.integrals(Emission::associated);
          for (std::size_t i = 0; i < truth.size(); ++i)
            EXPECT_LE(abs(truth[i] - numbers_of(found)[i]), found.radius)
                << what << ", number " << i << ": " << numbers_of(found)[i] << " against " << truth[i];
        }
}

TEST(SlabReference, TheConeOfEqualEnergyHasItsExactExponent) {
  for (const double shininess : {2.0, 3.0, 149.0, 1001.0, 999999.0}) {
    ShadedSlab slab{0, 1, 1, direction(0), {0, 0.28, 0.96}};
    Lighting lighting = lighting_from(direction(0), direction(0));
    lighting.highlight = find_named(catalogue::highlights(), "cone_energy");
    lighting.shininess = shininess;
    const auto found = slab_reference(slab, constant_transfer(3), Emission::associated, lighting);
    const auto truth = Slab50{slab, constant_transfer(3), lighting}.integrals(Emission::associated);
    EXPECT_LE(abs(truth[6] - found.specular[0]), found.radius) << shininess;
  }
}

TEST(SlabReference, RefusesWhatHasNoAnswer) {
  const Lighting lighting = lighting_from(direction(0), direction(0));
  const PiecewiseLinear transfer = ramp_transfer(1);
  const auto refuses = [&](const ShadedSlab& slab, const Lighting& light) {
    EXPECT_THROW(slab_reference(slab, transfer, Emission::plain, light), InputError);
  };
  refuses({0, 1, 1, {0, 0, 1}, {0, 0, -1}}, lighting);
  refuses({0, 1, 1, {0, 0, 1.00001}, {0, 0, 1}}, lighting);
  refuses({0, 1, -1, {0, 0, 1}, {0, 0, 1}}, lighting);
  refuses({0, std::nan(""), 1, {0, 0, 1}, {0, 0, 1}}, lighting);
  Lighting half_power = lighting;
  half_power.negative = Negative::none;
  half_power.shininess = 10.5;
  refuses({0, 1, 1, {0, 0, 1}, {0, 0, 1}}, half_power);
  half_power.negative = Negative::clamp;
  EXPECT_NO_THROW(slab_reference({0, 1, 1, {0, 0, 1}, {0, 0, 1}}, transfer, Emission::plain, half_power));
}

}  // namespace
}  // namespace raytruth
