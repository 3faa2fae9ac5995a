#include "raytruth/textures/texture_unit.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/trilinear_value.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace raytruth {
namespace {

const Texture four{.size = {4, 1, 1}, .dimensions = 1, .channels = 1, .texels = {0, 1, 5, 3}};

double linear(const Texture& texture, double x, int weight_bits = 0) {
  return TextureUnit<double>(texture, weight_bits).linear({x, 0, 0})[0];
}

TEST(TextureUnit, ReadsTexelsAtTheirCentres) {
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(linear(four, (i + 0.5) / 4), four.texels[i]);
    EXPECT_EQ(linear(four, (i + 0.5) / 4, 6), four.texels[i]);
  }
}

TEST(TextureUnit, FiltersBetweenCentres) {
  EXPECT_EQ(linear(four, 0.25), 0.5);
  EXPECT_EQ(linear(four, 0.4375), 2);  // position 1.25: 3/4 of 1 and 1/4 of 5
  EXPECT_EQ(linear(four, 0.75), 4);
}

TEST(TextureUnit, ClampsToItsEdge) {
  for (const double x : {-7.0, -0.1, 0.0, 0.125}) EXPECT_EQ(linear(four, x), 0) << x;
  for (const double x : {0.875, 1.0, 1.01, 9.0}) EXPECT_EQ(linear(four, x), 3) << x;
  const TextureUnit<double> unit(four);
  EXPECT_EQ(unit.nearest({-1, 0, 0})[0], 0);
  EXPECT_EQ(unit.nearest({1, 0, 0})[0], 3);
  EXPECT_EQ(unit.nearest({0.4999, 0, 0})[0], 1);
  EXPECT_EQ(unit.nearest({0.5, 0, 0})[0], 5);
}

TEST(TextureUnit, FillsUpTheChannelsThatAreNotThere) {
  const auto found = TextureUnit<double>(four).linear({0.375, 0, 0});
  EXPECT_EQ(found[1], 0);
  EXPECT_EQ(found[2], 0);
  EXPECT_EQ(found[3], 1);
}

TEST(TextureUnit, FiltersEveryChannelAndAxis) {
  const Texture square{
      .size = {2, 2, 1}, .dimensions = 2, .channels = 4, .texels = {0, 1, 2, 3, 8, 1, 4, 3, 0, 1, 8, 7, 16, 9, 2, 7}};
  // Positions 1/4 and 1/2: weights 3/4, 1/4 in x and 1/2, 1/2 in y.
  const auto found = TextureUnit<double>(square).linear({0.375, 0.5, 0});
  EXPECT_EQ(found[0], (2.0 + 4.0) / 2);
  EXPECT_EQ(found[1], (1.0 + 3.0) / 2);
  EXPECT_EQ(found[2], (2.5 + 6.5) / 2);
  EXPECT_EQ(found[3], 5);
}

TEST(TextureUnit, RoundsWeightsToBits) {
  const Texture two{.size = {2, 1, 1}, .dimensions = 1, .channels = 1, .texels = {0, 64}};
  const auto at_weight = [&](double weight, int bits) { return linear(two, 0.25 + weight / 2, bits); };
  EXPECT_EQ(at_weight(0.25, 6), 16);
  EXPECT_EQ(at_weight(0.25 + 1.0 / 256, 6), 16);
  EXPECT_EQ(at_weight(0.25 + 3.0 / 256, 6), 17);
  EXPECT_EQ(at_weight(0.25 + 3.0 / 256, 8), 16.75);
  EXPECT_EQ(at_weight(0.25 + 2.0 / 256, 6), 17);  // half a level is rounded up
  EXPECT_EQ(at_weight(1 - 1.0 / 512, 6), 64);     // to the next texel
}

TEST(TextureUnit, ManyBitsAreExact) {
  const Texture texture{.size = {4, 1, 1}, .dimensions = 1, .channels = 1, .texels = {0.25F, 1, -3.5F, 0.75F}};
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double x = random_numbers(1, RandomStream::points, i)[0];  // a multiple of 2^-32
    EXPECT_EQ(linear(texture, x, 40), linear(texture, x));
  }
}

TEST(TextureUnit, ExactFilteringIsTheTrilinearReconstruction) {
  const Grid field = random_field(5, 0, 3);
  Texture texture{.size = field.size, .dimensions = 3, .channels = 1};
  texture.texels.assign(field.values.begin(), field.values.end());
  Grid rounded = field;
  rounded.values.assign(texture.texels.begin(), texture.texels.end());
  const TextureUnit<double> exact(texture);
  const TextureUnit<Binary32> single(texture);
  const TextureUnit<Binary32> eight_bits(texture, 8);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto random = random_numbers(2, RandomStream::points, i);
    std::array<double, 3> voxel{};
    std::array<double, 3> coordinate{};
    std::array<Binary32, 3> rounded_coordinate{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rounded_coordinate[axis] = random[axis] * 1.25 - 0.125;
      coordinate[axis] = to_double(rounded_coordinate[axis]);
      voxel[axis] = coordinate[axis] * 5 - 0.5;
    }
    const double truth = exact.linear(coordinate)[0];
    EXPECT_NEAR(truth, trilinear_value(rounded, voxel), 2e-15);
    // A position of up to 6 is rounded to 2^-22, which moves the value by as much on each axis; then 3 weighted sums.
    EXPECT_NEAR(to_double(single.linear(rounded_coordinate)[0]), truth, 3 * 0x1p-22 + 6 * 0x1p-24);
    EXPECT_NEAR(to_double(eight_bits.linear(rounded_coordinate)[0]), truth, 3 * (0x1p-9 + 0x1p-22) + 6 * 0x1p-24);
  }
}

TEST(Texture, StoresTheNearestNumberOfItsFormat) {
  EXPECT_EQ(stored_texel(TexelType::unorm8, 0.5F), 128.0F / 255);  // 127.5 to the even neighbour or up: 128 either way
  EXPECT_EQ(stored_texel(TexelType::unorm8, 0.3F), 77.0F / 255);   // 76.5 and the rounding of 0.3
  EXPECT_EQ(stored_texel(TexelType::unorm8, 1.7F), 1);
  EXPECT_EQ(stored_texel(TexelType::unorm8, -0.2F), 0);
  EXPECT_EQ(stored_texel(TexelType::unorm16, 0.3F), 19661.0F / 65535);  // 19660.5 and the rounding
  EXPECT_EQ(stored_texel(TexelType::float16, 1.0F + 0x1p-11F), 1);      // halves to even
  EXPECT_EQ(stored_texel(TexelType::float16, 1.0F + 3 * 0x1p-11F), 1 + 0x1p-9F);
  EXPECT_EQ(stored_texel(TexelType::float16, 0x1p-25F), 0);
  EXPECT_EQ(stored_texel(TexelType::float16, 3 * 0x1p-25F), 0x1p-23F);  // subnormal
  EXPECT_EQ(stored_texel(TexelType::float32, 0.3F), 0.3F);
  for (int i = 0; i < 256; ++i) {
    const auto value = static_cast<float>(i) / 255;
    EXPECT_EQ(stored_texel(TexelType::unorm8, value), value);
  }
}

TEST(Texture, RefusesAFormatOfOtherChannels) { EXPECT_THROW(four.stored(TexelFormat::rgba8), InputError); }

}  // namespace
}  // namespace raytruth
