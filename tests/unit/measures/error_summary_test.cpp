#include "measures/error_summary.hpp"

#include "experiments/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

RayErrors three_rays() {
  RayErrors errors;
  errors.add({{3, 0, 0}, -1}, 1e-15);
  errors.add({{0, -6, 0}, 2}, 3e-15);
  errors.add({{0, 0, 6}, 2}, 2e-15);
  return errors;
}

double number(const Row& row, std::string_view name) { return as_number(cell(row, name)).value_or(std::nan("")); }

TEST(ErrorSummary, OfThreeRaysByHand) {
  const Row row = row_of(error_summary_columns("", "a ray"), summary_of(three_rays(), 2));
  EXPECT_NEAR(number(row, "opacity_bias"), 2 * 1.0, 1e-15);
  EXPECT_NEAR(number(row, "opacity_rms"), 2 * std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(number(row, "opacity_p50"), 2 * 2, 1e-15);
  EXPECT_NEAR(number(row, "opacity_p95"), 2 * 2, 1e-15);
  EXPECT_NEAR(number(row, "color_bias"), 2 * 3.0 / 9, 1e-15);
  EXPECT_NEAR(number(row, "color_rms"), 2 * 3, 1e-15);  // sqrt(81 / 9)
  EXPECT_NEAR(number(row, "color_p50"), 2 * 6, 1e-15);  // of 3, 6, 6: the largest channel of each
  EXPECT_NEAR(number(row, "color_max"), 2 * 6, 1e-15);
  EXPECT_EQ(number(row, "radius"), 2 * 3e-15);
}

TEST(ErrorSummary, IsNullWithoutRays) {
  const auto columns = error_summary_columns("", "a ray");
  const Row row = row_of(columns, summary_of({}));
  ASSERT_EQ(row.size(), columns.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i].first != "radius") {
      EXPECT_EQ(row[i].second, Value()) << row[i].first;
      EXPECT_EQ(columns[i].radius, "radius");
    }
  }
}

}  // namespace
}  // namespace raytruth
