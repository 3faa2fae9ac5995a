#include "raytruth/reference/surface_hits.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/reference/surroundings_of.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/signals/trilinear_value.hpp"

#include <flint/fmpq_poly.h>
#include <flint/fmpz_poly.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// Crossings of isosurfaces, against Sturm's chains and signs in rational numbers by FLINT, which share nothing with how
// they are found but the numbers; against the rules for what touches, for kinks, jumps, ends and level stretches; and,
// along rays through volumes, against signs in 50 digits.
namespace raytruth {
namespace {

/// Numbers uniform in [0, 1).
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : seed_(seed) {}
  double uniform() { return random_numbers(seed_, RandomStream::cases, index_++)[0]; }

 private:
  std::uint64_t seed_;
  std::uint64_t index_ = 0;
};

/// A polynomial in powers of u less a number, in rational numbers.
class Exact {
 public:
  Exact(const std::vector<double>& powers, double scalar) {
    fmpq_poly_init(p_);
    fmpz_poly_init(zeros_);
    for (std::size_t k = 0; k < powers.size(); ++k) set(k, powers[k]);
    fmpq_poly_t constant;
    fmpq_poly_init(constant);
    fmpq_t value;
    fmpq_init(value);
    to_rational(scalar, value);
    fmpq_poly_set_fmpq(constant, value);
    fmpq_poly_sub(p_, p_, constant);
    fmpq_clear(value);
    fmpq_poly_clear(constant);
    // The polynomial over its greatest common divisor with its derivative: the same zeros, simple ones.
    fmpz_poly_t numerator;
    fmpz_poly_t divisor;
    fmpz_poly_init(numerator);
    fmpz_poly_init(divisor);
    fmpq_poly_get_numerator(numerator, p_);
    if (fmpz_poly_is_zero(numerator) == 0) {
      fmpz_poly_derivative(divisor, numerator);
      fmpz_poly_gcd(divisor, numerator, divisor);
      fmpz_poly_div(zeros_, numerator, divisor);
    }
    fmpz_poly_clear(divisor);
    fmpz_poly_clear(numerator);
  }
  ~Exact() {
    fmpq_poly_clear(p_);
    fmpz_poly_clear(zeros_);
  }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;

  /// Brackets of the crossings in (0, 1), in units of 2^-62.
  [[nodiscard]] std::vector<std::pair<std::int64_t, std::int64_t>> crossings() const {
    std::vector<std::pair<std::int64_t, std::int64_t>> result;
    if (fmpz_poly_degree(zeros_) < 1) return result;
    isolate(0, whole, above(0), above(whole), result);
    return result;
  }

  static constexpr std::int64_t whole = std::int64_t{1} << 62;

  [[nodiscard]] int sign(std::int64_t place) const {
    fmpq_t x;
    fmpq_t value;
    fmpq_init(x);
    fmpq_init(value);
    fmpq_set_si(x, place, static_cast<ulong>(whole));
    fmpq_poly_evaluate_fmpq(value, p_, x);
    const int sign = fmpq_sgn(value);
    fmpq_clear(value);
    fmpq_clear(x);
    return sign;
  }

 private:
  static void to_rational(double x, fmpq_t value) {
    int exponent = 0;
    fmpz_set_d(fmpq_numref(value), std::ldexp(std::frexp(x, &exponent), 53));
    fmpz_one(fmpq_denref(value));
    exponent -= 53;
    if (exponent > 0) fmpq_mul_2exp(value, value, static_cast<ulong>(exponent));
    if (exponent < 0) fmpq_div_2exp(value, value, static_cast<ulong>(-exponent));
    fmpq_canonicalise(value);
  }
  void set(std::size_t power, double x) {
    fmpq_t value;
    fmpq_init(value);
    to_rational(x, value);
    fmpq_poly_set_coeff_fmpq(p_, static_cast<slong>(power), value);
    fmpq_clear(value);
  }
  /// How many zeros are above a place.
  [[nodiscard]] slong above(std::int64_t place) const {
    fmpq_poly_t shifted;
    fmpq_poly_t shift;
    fmpz_poly_t numerator;
    fmpq_poly_init(shifted);
    fmpq_poly_init(shift);
    fmpz_poly_init(numerator);
    fmpq_t x;
    fmpq_init(x);
    fmpq_set_si(x, place, static_cast<ulong>(whole));
    fmpq_poly_set_coeff_si(shift, 1, 1);
    fmpq_poly_set_coeff_fmpq(shift, 0, x);
    fmpq_poly_set_fmpz_poly(shifted, zeros_);
    fmpq_poly_compose(shifted, shifted, shift);
    fmpq_poly_get_numerator(numerator, shifted);
    while (fmpz_poly_degree(numerator) > 0 && fmpz_sgn(fmpz_poly_get_coeff_ptr(numerator, 0)) == 0)
      fmpz_poly_shift_right(numerator, numerator, 1);
    slong negative = 0;
    slong positive = 0;
    if (fmpz_poly_degree(numerator) > 0)
      _fmpz_poly_num_real_roots_sturm(&negative, &positive, numerator->coeffs, fmpz_poly_length(numerator));
    fmpq_clear(x);
    fmpz_poly_clear(numerator);
    fmpq_poly_clear(shift);
    fmpq_poly_clear(shifted);
    return positive;
  }
  /// Crossings strictly between two places; `above`: how many zeros are above each. A zero at the upper place is in the
  /// bracket's interval, but no sign changes there.
  void isolate(std::int64_t begin, std::int64_t end, slong above_begin, slong above_end,
               std::vector<std::pair<std::int64_t, std::int64_t>>& result) const {
    if (above_begin == above_end) return;
    if (above_begin - above_end == 1) {
      // One zero in (begin, end]; signs on both sides of it tell whether it is crossed.
      int first = sign(begin);
      for (std::int64_t offset = 1; first == 0 && begin + offset < end; offset *= 2) {
        if (above(begin + offset) != above_begin) break;
        first = sign(begin + offset);
      }
      const int last = sign(end);
      if (last == 0 && end == whole) return;
      const int behind = last != 0 ? last : sign(end + 1);
      if (first == behind) return;
      while (end - begin > 1) {
        const std::int64_t middle = begin + (end - begin) / 2;
        if (above(middle) == above_begin)
          begin = middle;
        else
          end = middle;
      }
      result.emplace_back(begin, end);
      return;
    }
    if (end - begin <= 1) throw std::runtime_error("zeros nearer than 2^-62");
    const std::int64_t middle = begin + (end - begin) / 2;
    const slong above_middle = above(middle);
    isolate(begin, middle, above_begin, above_middle, result);
    isolate(middle, end, above_middle, above_end, result);
  }

  fmpq_poly_t p_;
  fmpz_poly_t zeros_;
};

/// The product of (u - zero) over all zeros, times a factor.
std::vector<double> from_zeros(const std::vector<double>& zeros, double factor) {
  std::vector<double> powers{factor};
  for (const double zero : zeros) {
    powers.push_back(0);
    for (std::size_t k = powers.size() - 1; k > 0; --k) powers[k] = powers[k - 1] - zero * powers[k];
    powers[0] *= -zero;
  }
  return powers;
}

SurfaceHits hits_of(const std::vector<double>& powers, const std::vector<double>& scalars) {
  return surface_hits(precise_piecewise_polynomial({0, 1}, {powers}), scalars);
}

/// Compares all hits with what rational numbers say.
void expect_exact(const std::vector<double>& powers, const std::vector<double>& scalars) {
  const SurfaceHits found = hits_of(powers, scalars);
  EXPECT_TRUE(found.unresolved.empty());
  std::vector<std::size_t> next(scalars.size());
  std::vector<std::vector<std::pair<std::int64_t, std::int64_t>>> expected;
  std::vector<int> sides(scalars.size());
  std::size_t count = 0;
  std::vector<std::unique_ptr<Exact>> exact;
  for (const double scalar : scalars) {
    exact.push_back(std::make_unique<Exact>(powers, scalar));
    expected.push_back(exact.back()->crossings());
    count += expected.back().size();
  }
  ASSERT_EQ(found.hits.size(), count);
  std::int64_t before = 0;
  for (const SurfaceHit& hit : found.hits) {
    const auto& brackets = expected[hit.surface];
    ASSERT_LT(next[hit.surface], brackets.size());
    const auto [low, high] = brackets[next[hit.surface]++];
    EXPECT_LE(before, high);  // their order, as far as the brackets tell it
    before = std::max(before, low);
    EXPECT_EQ(hit.is_rising, exact[hit.surface]->sign(high) > 0 ||
                                 (exact[hit.surface]->sign(high) == 0 && exact[hit.surface]->sign(high + 1) > 0));
    const auto t = static_cast<double>(hit.t);
    const double radius = hit.error + std::abs(static_cast<double>(hit.t - t));
    EXPECT_LE(radius, 1e-13);
    EXPECT_GE(t + radius, std::ldexp(static_cast<double>(low), -62) - 0x1p-62);
    EXPECT_LE(t - radius, std::ldexp(static_cast<double>(high), -62) + 0x1p-62);
  }
}

void expect_exact_cubics(int count) {
  Numbers random(22);
  const auto uniform = [&random] { return 2 * random.uniform() - 1; };
  const auto whole = [&random](int most) { return std::floor(random.uniform() * (2 * most + 1)) - most; };
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    switch (i % 5) {
      case 0:
        expect_exact({uniform(), uniform() * 4, uniform() * 8, uniform() * 8}, {uniform() / 4});
        break;
      case 1:  // whole numbers: zeros at the ends, constants, and double ones
        expect_exact({whole(2), whole(3), whole(3), whole(2)}, {-1, 0, 1});
        break;
      case 2: {  // touched, and crossed elsewhere
        const double twice = whole(64) / 64;
        expect_exact(from_zeros({twice, twice, whole(64) / 64}, whole(3) + 0.5), {0, 0x1p-40});
        break;
      }
      case 3: {  // threefold
        const double zero = whole(1024) / 1024;
        expect_exact(from_zeros({zero, zero, zero}, whole(3) + 0.5), {-0x1p-30, 0});
        break;
      }
      default: {  // nearly touched, from either side
        const double twice = whole(32) / 32;
        std::vector<double> powers = from_zeros({twice, twice, whole(4) / 4}, 1);
        powers[0] += std::ldexp(whole(1), -20);
        expect_exact(powers, {0});
      }
    }
  }
}

TEST(SurfaceHits, CubicsAgainstRationalNumbers) { expect_exact_cubics(10'000); }

TEST(SurfaceHitsCampaign, TenTimesAsManyCubics) { expect_exact_cubics(100'000); }

TEST(SurfaceHits, DegreeNineAgainstRationalNumbers) {
  Numbers random(9);
  for (int i = 0; i < 20 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    std::vector<double> powers;
    double scale = 1;
    for (int k = 0; k <= 9; ++k, scale *= 3) powers.push_back((2 * random.uniform() - 1) * scale);
    expect_exact(powers, {-0.25, 0, 0x1p-60, 0.25});
  }
  for (int order = 1; order <= 9; ++order) {
    SCOPED_TRACE(order);
    expect_exact(from_zeros(std::vector<double>(static_cast<std::size_t>(order), 0.25), 1), {-0x1p-70, 0, 0x1p-70});
  }
}

/// A chain in Bernstein form stands for itself.
TEST(SurfaceHits, ChainsThatStandForThemselves) {
  const Chain<3> cubic{{{0.0, 2, {{0, 1, -1, 0}}}}, 2.0};  // crosses 0 in its middle, and begins and ends there
  const SurfaceHits found = surface_hits(precise_chain(cubic), {0});
  EXPECT_TRUE(found.unresolved.empty());
  ASSERT_EQ(found.hits.size(), 1U);
  EXPECT_EQ(static_cast<double>(found.hits[0].t), 1);
  EXPECT_LE(found.hits[0].error, 2e-13);
  EXPECT_FALSE(found.hits[0].is_rising);
}

struct Rule {
  std::string name;
  std::vector<double> breaks;
  std::vector<std::vector<double>> powers;
  std::vector<double> scalars;
  std::vector<std::pair<double, std::size_t>> hits;  ///< t and surface
};

TEST(SurfaceHits, Rules) {
  const std::vector<Rule> rules{
      {"ends count as nothing", {0, 1}, {{0, 1}}, {0, 1}, {}},
      {"both directions", {0, 1, 2}, {{0, 1}, {1, -1}}, {0.5}, {{0.5, 0}, {1.5, 0}}},
      {"a kink that touches", {0, 1, 2}, {{0, 1}, {1, -1}}, {1}, {}},
      {"a kink that crosses", {0, 1, 2}, {{0, 1}, {1, 2}}, {1}, {{1, 0}}},
      {"level, then on", {0, 1, 2, 3}, {{0, 1}, {1}, {1, 1}}, {1}, {{1, 0}}},
      {"level, then back", {0, 1, 2, 3}, {{0, 1}, {1}, {1, -1}}, {1}, {}},
      {"level at the beginning", {0, 1, 2}, {{1}, {1, 1}}, {1}, {}},
      {"level at the end", {0, 1, 2}, {{0, 1}, {1}}, {1}, {}},
      {"two level pieces", {0, 1, 2, 3, 4}, {{0, 1}, {1}, {1}, {1, 1}}, {1}, {{1, 0}}},
      {"level all along", {0, 1}, {{1}}, {1}, {}},
      {"a jump over several", {0, 1, 2}, {{0}, {4}}, {1, 2, 3}, {{1, 0}, {1, 1}, {1, 2}}},
      {"a jump down over several", {0, 1, 2}, {{4}, {0}}, {1, 2, 3}, {{1, 2}, {1, 1}, {1, 0}}},
      {"a jump onto one", {0, 1, 2, 3}, {{0}, {2}, {3}}, {1, 2}, {{1, 0}, {1, 1}}},
      {"a jump off one, back", {0, 1, 2, 3}, {{0}, {2}, {0}}, {1, 2}, {{1, 0}, {2, 0}}},
      {"several in a piece", {0, 1}, {{0, 4}}, {1, 2, 3}, {{0.25, 0}, {0.5, 1}, {0.75, 2}}},
      {"several, downwards", {0, 1}, {{4, -4}}, {1, 2, 3}, {{0.25, 2}, {0.5, 1}, {0.75, 0}}},
      {"there and back", {0, 1}, {{0, 4, -4}}, {0.75, 1}, {{0.25, 0}, {0.75, 0}}},
  };
  for (const Rule& rule : rules) {
    SCOPED_TRACE(rule.name);
    const SurfaceHits found = surface_hits(precise_piecewise_polynomial(rule.breaks, rule.powers), rule.scalars);
    EXPECT_TRUE(found.unresolved.empty());
    ASSERT_EQ(found.hits.size(), rule.hits.size());
    for (std::size_t i = 0; i < rule.hits.size(); ++i) {
      EXPECT_EQ(found.hits[i].surface, rule.hits[i].second);
      EXPECT_NEAR(static_cast<double>(found.hits[i].t), rule.hits[i].first, found.hits[i].error);
      EXPECT_LE(found.hits[i].error, 1e-13);
    }
  }
}

/// Surfaces that neighbouring numbers tell apart, and no difference of places in binary64 does.
TEST(SurfaceHits, NeighbouringSurfacesKeepTheirOrder) {
  const double next = std::nextafter(0.5, 1);
  for (const double sign : {1.0, -1.0}) {
    const SurfaceHits found = hits_of({sign > 0 ? 0.0 : 1e6, sign * 1e6}, {0.5, next});
    ASSERT_EQ(found.hits.size(), 2U);
    EXPECT_EQ(found.hits[0].surface, sign > 0 ? 0U : 1U);
  }
  // Both ways, within 2^-200 of an extremum: up through both, and down again.
  const SurfaceHits peak = hits_of({-0x1p-2, 1, -1}, {-0x1p-400, -0x1p-401});
  std::vector<std::size_t> surfaces;
  for (const SurfaceHit& hit : peak.hits) surfaces.push_back(hit.surface);
  EXPECT_EQ(surfaces, (std::vector<std::size_t>{0, 1, 1, 0}));
}

/// The scalar in 50 digits, along the ray at its exactly normalised direction.
int sign_along(const Grid& grid, const Ray& ray, double entry, double t, double scalar) {
  const Real50 norm = sqrt(Real50(ray.direction[0]) * ray.direction[0] + Real50(ray.direction[1]) * ray.direction[1] +
                           Real50(ray.direction[2]) * ray.direction[2]);
  std::array<Real50, 3> place;
  for (std::size_t axis = 0; axis < 3; ++axis)
    place[axis] = Real50(ray.origin[axis]) + (Real50(entry) + Real50(t)) * ray.direction[axis] / norm;
  const Real50 value = trilinear_value(grid, place) - scalar;
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

TEST(SurfaceHits, RaysThroughVolumesAgainstFiftyDigits) {
  const Grid grid = random_field(12, 0, 3);
  const TrilinearField field(grid);
  Numbers random(5);
  std::size_t hits = 0;
  for (int i = 0; i < 40 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    Ray ray{.origin = {5 + random.uniform(), 5 + random.uniform(), 5 + random.uniform()},
            .direction = {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5},
            .length = 5};
    const SurfaceHits found =
        surface_hits(field.trace_precisely(ray), {0.3, 0.5, 0.7}, surroundings_of(field, ray.direction));
    EXPECT_TRUE(found.unresolved.empty());
    for (const SurfaceHit& hit : found.hits) {
      const auto t = static_cast<double>(hit.t);
      const double radius = hit.error + 0x1p-50;
      EXPECT_LE(hit.error, 1e-13);
      const double scalar = std::array{0.3, 0.5, 0.7}[hit.surface];
      EXPECT_EQ(sign_along(grid, ray, 0, t - radius, scalar), hit.is_rising ? -1 : 1);
      EXPECT_EQ(sign_along(grid, ray, 0, t + radius, scalar), hit.is_rising ? 1 : -1);
    }
    // Between hits nothing is crossed.
    for (std::size_t surface = 0; surface < 3; ++surface) {
      const double scalar = std::array{0.3, 0.5, 0.7}[surface];
      std::size_t crossings = 0;
      int before = sign_along(grid, ray, 0, 0, scalar);
      for (int step = 1; step <= 400; ++step) {
        const int here = sign_along(grid, ray, 0, 5.0 * step / 400, scalar);
        if (here != before) ++crossings;
        before = here;
      }
      const auto its = std::count_if(found.hits.begin(), found.hits.end(),
                                     [&](const SurfaceHit& hit) { return hit.surface == surface; });
      EXPECT_GE(static_cast<std::size_t>(its), crossings);
      EXPECT_EQ(static_cast<std::size_t>(its) % 2, crossings % 2);
    }
    hits += found.hits.size();
  }
  EXPECT_GT(hits, 100U);
}

/// Along a row of voxels the scalar is exactly the voxels' own: surfaces on their values are met at their centres.
TEST(SurfaceHits, SurfacesOnVoxelValues) {
  Grid grid;
  grid.size = {8, 2, 2};
  const std::vector<double> row{0, 1, 2, 2, 3, 1, 1, 0};
  for (int plane = 0; plane < 4; ++plane) grid.values.insert(grid.values.end(), row.begin(), row.end());
  const TrilinearField field(grid);
  const SurfaceHits found =
      surface_hits(field.trace_precisely({.origin = {0, 0, 0}, .direction = {1, 0, 0}, .length = 7}), {1, 2, 3},
                   surroundings_of(field, {1, 0, 0}));
  // The highest voxel touches the surface of its value: whether the ray meets its centre is a matter of rounding.
  ASSERT_EQ(found.unresolved.size(), 1U);
  EXPECT_EQ(found.unresolved[0].surface, 2U);
  EXPECT_NEAR(found.unresolved[0].from, 4, 1e-13);
  EXPECT_NEAR(found.unresolved[0].to, 4, 1e-13);
  const std::vector<std::pair<double, std::size_t>> expected{{1, 0}, {2, 1}, {4.5, 1}, {5, 0}};
  ASSERT_EQ(found.hits.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(found.hits[i].t), expected[i].first, found.hits[i].error);
    EXPECT_EQ(found.hits[i].surface, expected[i].second);
    EXPECT_LE(found.hits[i].error, 1e-13);
  }
}

}  // namespace
}  // namespace raytruth
