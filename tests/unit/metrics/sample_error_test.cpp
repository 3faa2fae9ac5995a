#include "raytruth/metrics/sample_error.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

SampleError error_of(std::initializer_list<double> differences) {
  SampleError error;
  for (const double difference : differences) error.add(difference);
  return error;
}

TEST(SampleError, ByHand) {
  // Squares 9, 16, 0, 0: mean 25/4, root 5/2; 20 log10(25 / 2.5) = 20.
  const SampleError error = error_of({3, -4, 0, 0});
  EXPECT_EQ(error.count, 4);
  EXPECT_EQ(error.rmse(), 2.5);
  EXPECT_EQ(error.maximum, 4);
  EXPECT_EQ(error.psnr(25), 20);
  // Ten times the peak is 20 dB more, for the same error.
  EXPECT_EQ(error.psnr(250), 40);
}

TEST(SampleError, FiguresOfLee) {
  // Section 5.2: levels from 0 to 10000; RMSE 2.32 and 2.49, printed as 72.7 and 72.1 dB.
  EXPECT_NEAR(error_of({2.32, -2.32}).psnr(10000).value_or(0), 72.69, 0.005);
  EXPECT_NEAR(error_of({2.49}).psnr(10000).value_or(0), 72.08, 0.005);
}

TEST(SampleError, NoneWhereThereIsNothingToSay) {
  EXPECT_FALSE(SampleError{}.rmse());
  EXPECT_FALSE(SampleError{}.psnr(1));
  EXPECT_EQ(error_of({0, 0}).rmse(), 0);
  EXPECT_FALSE(error_of({0, 0}).psnr(1));
}

TEST(SampleError, OfPartsIsThatOfTheWhole) {
  SampleError sum = error_of({3});
  sum += error_of({});
  sum += error_of({-4, 0, 0});
  EXPECT_EQ(sum.count, 4);
  EXPECT_EQ(sum.rmse(), 2.5);
  EXPECT_EQ(sum.maximum, 4);
}

}  // namespace
}  // namespace raytruth
