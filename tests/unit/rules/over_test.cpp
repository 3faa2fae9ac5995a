#include "raytruth/core/real50.hpp"
#include "raytruth/rules/rules.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

template <class Real>
class Over : public testing::Test {
 protected:
  using Slab = typename Rules<Real>::vec4;

  static Slab slab(double r, double g, double b, double opacity) { return {Real(r), Real(g), Real(b), Real(opacity)}; }
  static Slab over(const Slab& front, const Slab& back) { return Rules<Real>{}.over(front, back); }
  static void expect_equal(const Slab& a, const Slab& b) {
    for (int i = 0; i < 4; ++i) EXPECT_EQ(a[i], b[i]);
  }
};
using Reals = testing::Types<double, Real50>;
TYPED_TEST_SUITE(Over, Reals);

TYPED_TEST(Over, HasTheEmptySlabAsItsUnit) {
  const auto empty = this->slab(0, 0, 0, 0);
  const auto slab = this->slab(0.25, 0.5, 0.125, 0.25);
  this->expect_equal(this->over(empty, slab), slab);
  this->expect_equal(this->over(slab, empty), slab);
}

TYPED_TEST(Over, IsAssociative) {
  // Dyadic numbers, so that both orders are exact.
  const auto a = this->slab(0.5, 0.25, 0, 0.5);
  const auto b = this->slab(0.125, 1, 0.75, 0.75);
  const auto c = this->slab(2, 0.375, 0.5, 0.875);
  const auto left = this->over(this->over(a, b), c);
  this->expect_equal(left, this->over(a, this->over(b, c)));
  EXPECT_EQ(left[3], TypeParam(63.0 / 64));
  EXPECT_EQ(left[0], TypeParam(0.5 + 0.5 * (0.125 + 0.25 * 2)));
}

}  // namespace
}  // namespace raytruth
