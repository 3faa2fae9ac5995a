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
  image.at(1, 0) = {-0.25, 0.125, 2, 1};  // -1/2, +1/8, +1; clamped: -1/4, +1/8, 0
  const ImageError stored = image_error(image, reference);
  EXPECT_EQ(stored.maximum, 1);
  EXPECT_EQ(stored.place, (std::array<std::int64_t, 2>{1, 0}));
  EXPECT_DOUBLE_EQ(stored.bias, 0.875 / 6);
  EXPECT_DOUBLE_EQ(stored.rmse, std::sqrt((1.0 / 16 + 1.0 / 4 + 1.0 / 64 + 1) / 6));
  EXPECT_DOUBLE_EQ(stored.relative.value(), 1.875 / 2);
  EXPECT_DOUBLE_EQ(image_error(image, reference, Channels::color, 255).psnr.value(),
                   20 * std::log10(255 / stored.rmse));

  const ImageError opacity = image_error(image, reference, Channels::opacity);
  EXPECT_EQ(opacity.maximum, 1);
  EXPECT_DOUBLE_EQ(opacity.rmse, std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(image_error(image, reference, Channels::all).rmse,
                   std::sqrt((1.0 / 16 + 1.0 / 4 + 1.0 / 64 + 1 + 1) / 8));

  const ClampedImage shown = clamped(image);
  EXPECT_EQ(shown.count, 2);
  const ImageError error = image_error(shown.image, reference);
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
