#include "core/slab.hpp"
#include "core/real.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

template <class Real>
class SlabTest : public testing::Test {};
using Reals = testing::Types<double, Real50>;
TYPED_TEST_SUITE(SlabTest, Reals);

TYPED_TEST(SlabTest, EmptySlabIsTheUnitOfOver) {
  using Real = TypeParam;
  const Slab<Real> slab{Vector3<Real>(Real(0.25), Real(0.5), Real(0.125)), Real(0.75)};
  for (const auto& same : {over(Slab<Real>{}, slab), over(slab, Slab<Real>{})}) {
    EXPECT_EQ(same.transmittance, slab.transmittance);
    for (int channel = 0; channel < 3; ++channel) EXPECT_EQ(same.radiance[channel], slab.radiance[channel]);
  }
  EXPECT_EQ(Slab<Real>{}.opacity(), Real(0));
}

TYPED_TEST(SlabTest, OverIsAssociative) {
  using Real = TypeParam;
  // Dyadic numbers, so that both orders are exact.
  const auto slab = [](double r, double g, double b, double t) {
    return Slab<Real>{Vector3<Real>(Real(r), Real(g), Real(b)), Real(t)};
  };
  const auto a = slab(0.5, 0.25, 0, 0.5);
  const auto b = slab(0.125, 1, 0.75, 0.25);
  const auto c = slab(2, 0.375, 0.5, 0.125);
  const auto left = over(over(a, b), c);
  const auto right = over(a, over(b, c));
  EXPECT_EQ(left.transmittance, right.transmittance);
  for (int channel = 0; channel < 3; ++channel) EXPECT_EQ(left.radiance[channel], right.radiance[channel]);
  EXPECT_EQ(left.transmittance, Real(1.0 / 64));
  EXPECT_EQ(left.radiance[0], Real(0.5 + 0.5 * (0.125 + 0.25 * 2)));
}

}  // namespace
}  // namespace raytruth
