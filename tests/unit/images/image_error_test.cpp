#include "raytruth/images/image_error.hpp"

#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

TEST(ImageError, OfTwoPixelsComputedByHand) {
  Image reference({2, 1});
  reference.at(0, 0) = {0.5, 0.25, 0, 1};
  reference.at(1, 0) = {0.25, 0, 1, 1};
  Image image = reference;
  image.at(0, 0) = {0.5, 0.5, 0, 0};      // +1/4 in one channel; opacity is no light
  image.at(1, 0) = {-0.25, 0.125, 2, 1};  // clamped: -1/4, +1/8, 0
  const ImageError error = image_error(image, reference);
  EXPECT_EQ(error.maximum, 0.25);
  EXPECT_EQ(error.place, (std::array<std::int64_t, 2>{0, 0}));
  EXPECT_DOUBLE_EQ(error.bias, 0.125 / 6);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((1.0 / 16 + 1.0 / 16 + 1.0 / 64) / 6));
  EXPECT_DOUBLE_EQ(error.psnr.value(), 20 * std::log10(1 / error.rmse));
  EXPECT_DOUBLE_EQ(error.relative.value(), 0.625 / 2);
}

TEST(ImageError, OfEqualAndOfBlackImages) {
  Image image({3, 2});
  image.at(2, 1) = {0.5, 0.5, 0.5, 1};
  const ImageError none = image_error(image, image);
  EXPECT_EQ(none.maximum, 0);
  EXPECT_FALSE(none.psnr.has_value());
  EXPECT_EQ(none.relative, 0);
  const ImageError over_black = image_error(image, Image({3, 2}));
  EXPECT_EQ(over_black.place, (std::array<std::int64_t, 2>{2, 1}));
  EXPECT_FALSE(over_black.relative.has_value());
  EXPECT_THROW(image_error(image, Image({2, 3})), InputError);
}

}  // namespace
}  // namespace raytruth
