#pragma once

#include "reference/certified.hpp"
#include "tables/table.hpp"
#include "tables/table_cost.hpp"
#include "transfer/piecewise_linear.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace raytruth {

/// A way to a table of pre-integrated slabs: a row of the catalogue.
struct TableBuilder {
  std::string name = {};
  std::string_view summary = {};
  std::string_view source = {};
  /// Throws InputError as `check` does for the axes.
  Table<double> (*make)(const PiecewiseLinear&, const TableAxes&, Emission) = nullptr;
  /// What n x n entries take, in closed form; null where that depends on the transfer function, or was not asked.
  TableCost (*cost)(std::int64_t size) = nullptr;
};

}  // namespace raytruth
