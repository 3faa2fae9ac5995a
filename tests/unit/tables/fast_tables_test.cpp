#include "raytruth/tables/fast_tables.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/kernels/table_kernels.hpp"
#include "raytruth/tables/moments.hpp"
#include "raytruth/tables/subrange.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace raytruth {
namespace {

// Binary32 rounds by 6e-8; a slab is up to 2000 composites whose errors are damped, and the opacity of an interval has
// a relative error of 5e-7.
constexpr double allowed = 1e-5;

double largest_difference(const Table<float>& a, const Table<double>& b) {
  double result = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double difference = std::abs(static_cast<double>(a.values[i]) - b.values[i]);
    if (!(difference <= result)) result = difference;  // what is no number counts
  }
  return result;
}

/// Means of a random transfer function; three opaque intervals and entries among them, and two that are empty.
DiscreteTransfer transfer_function(const TableAxes& axes, double extinction, Emission emission) {
  DiscreteTransfer transfer = interval_means(random_transfer(extinction, 5), axes, emission);
  const auto set = [&](std::size_t i, double to) {
    if (i >= transfer.intervals.size()) return;
    transfer.intervals[i].extinction = to;
    transfer.entries[i].extinction = to;
  };
  for (const std::size_t i : {3U, 40U, 200U}) set(i, std::numeric_limits<double>::infinity());
  for (const std::size_t i : {5U, 6U}) set(i, 0);
  return transfer;
}

TEST(FastTables, AreTheTablesInBinary64OnEveryLevel) {
  for (const std::size_t size : {2U, 3U, 4U, 5U, 15U, 16U, 17U, 18U, 33U, 100U, 256U})
    for (const double extinction : {0.1, 5.0, 300.0})
      for (const Emission emission : {Emission::associated, Emission::plain}) {
        const TableAxes axes{.size = size, .length = 1};
        const DiscreteTransfer transfer = transfer_function(axes, extinction, emission);
        const auto slabs = subrange_table<double>(transfer, axes);
        const auto moments = moment_tables(transfer, axes).moments;
        for (const TableKernels* const kernels : table_kernel_versions()) {
          SCOPED_TRACE(testing::Message() << size << ' ' << extinction << " lanes " << kernels->band_width);
          Table<float> fast;
          build_subrange_table(transfer, axes, fast, kernels);
          EXPECT_LE(largest_difference(fast, slabs), allowed);
          std::array<Table<float>, 4> fast_moments;
          build_moment_tables(transfer, axes, fast_moments, kernels);
          for (std::size_t k = 0; k < 4; ++k) EXPECT_LE(largest_difference(fast_moments[k], moments[k]), allowed) << k;
        }
      }
}

TEST(FastTables, KeepTheDigitsOfFaintSlabs) {
  // Constant: all entries have one opacity, of which no digit may be lost to 1 - T.
  const TableAxes axes{.size = 300};
  const double extinction = 1e-6;
  const PiecewiseLinear transfer({{0, {extinction, {1, 1, 1}}}});
  Table<float> table;
  build_subrange_table(interval_means(transfer, axes, Emission::associated), axes, table);
  for (std::size_t i = 3; i < table.values.size(); i += 4)
    EXPECT_NEAR(static_cast<double>(table.values[i]) / -std::expm1(-extinction), 1, 1e-5);
}

TEST(FastTables, HaveTheSameBytesOnAnyNumberOfThreads) {
  const TableAxes axes{.size = 200, .length = 2};
  const DiscreteTransfer transfer = transfer_function(axes, 5, Emission::associated);
  std::array<std::vector<float>, 2> slabs;
  std::array<std::vector<float>, 2> moments;
  for (std::size_t run = 0; run < 2; ++run) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, run == 0 ? 1 : 4);
    Table<float> table;
    build_subrange_table(transfer, axes, table);
    slabs[run] = table.values;
    std::array<Table<float>, 4> tables;
    build_moment_tables(transfer, axes, tables);
    moments[run] = tables[3].values;
  }
  EXPECT_EQ(slabs[0], slabs[1]);
  EXPECT_EQ(moments[0], moments[1]);
}

TEST(FastTables, AreRebuiltInTheirMemory) {
  TableAxes axes{.size = 64};
  Table<float> table;
  build_subrange_table(transfer_function(axes, 5, Emission::associated), axes, table);
  const float* const memory = table.values.data();
  axes.length = 3;
  const DiscreteTransfer transfer = transfer_function(axes, 9, Emission::associated);
  build_subrange_table(transfer, axes, table);
  EXPECT_EQ(table.values.data(), memory);
  EXPECT_EQ(table.axes.length, 3);
  EXPECT_LE(largest_difference(table, subrange_table<double>(transfer, axes)), allowed);
  axes.length = -1;
  EXPECT_THROW(build_subrange_table(transfer, axes, table), InputError);
}

}  // namespace
}  // namespace raytruth
