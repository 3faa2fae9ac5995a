#include "raytruth/tables/table_for_format.hpp"

#include "raytruth/core/named.hpp"
#include "raytruth/tables/table_builders.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace raytruth {
namespace {

constexpr TableAxes axes{.size = 65, .length = 1};
constexpr double stated = 1e-5;

double largest_difference(const Table<double>& a, const Table<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
  return largest;
}

TEST(TableForFormat, IsTheBuildersTableToItsStatedError) {
  const PiecewiseLinear transfer = random_transfer(4, 1);
  int fast = 0;
  for (const TableBuilder& builder : catalogue::table_builders())
    for (const Emission emission : {Emission::associated, Emission::plain}) {
      SCOPED_TRACE(builder.name);
      const Table<double> exact = builder.make(transfer, axes, emission);
      EXPECT_EQ(table_for_format(builder, transfer, axes, emission, table_formats[0]).values, exact.values);
      const double found =
          largest_difference(table_for_format(builder, transfer, axes, emission, table_formats[1]), exact);
      EXPECT_LE(found, stated);
      EXPECT_EQ(found > 0, is_made_in_binary32(builder, transfer, table_formats[1]));
      fast += is_made_in_binary32(builder, transfer, table_formats[1]) ? 1 : 0;
    }
  EXPECT_EQ(fast, 2 * 6);  // subrange, subrange_means, moment_0 to moment_3
}

TEST(TableForFormat, IsTheBuildersOwnForColorsAboveOne) {
  const PiecewiseLinear bright({{0, {1, {1, 1, 1}}}, {1, {1, {1, 1, 1e30}}}});
  for (const TableBuilder& builder : catalogue::table_builders()) {
    SCOPED_TRACE(builder.name);
    EXPECT_FALSE(is_made_in_binary32(builder, bright, table_formats[1]));
    EXPECT_EQ(table_for_format(builder, bright, axes, Emission::plain, table_formats[1]).values,
              builder.make(bright, axes, Emission::plain).values);
  }
}

}  // namespace
}  // namespace raytruth
