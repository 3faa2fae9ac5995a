#pragma once

#include "raytruth/tables/table.hpp"
#include "raytruth/tables/table_cost.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace raytruth {

/// By what the light is weighted that comes from the share x of a slab, 0 at its front and 1 at its back.
enum class LightWeight {
  one,
  to_front,  ///< 1 - x
  x,
  x_squared,
  x_cubed,
  tent,  ///< 2 x up to 1/2, then 2 - 2 x
};

/// What a table's entries are.
struct TableContent {
  LightWeight weight = LightWeight::one;
  bool is_white = false;            ///< RGB are the light of white matter
  bool has_white_as_alpha = false;  ///< the fourth channel is the weighted light of white matter; else the opacity

  [[nodiscard]] bool is_slab() const { return weight == LightWeight::one && !is_white && !has_white_as_alpha; }
};

/// A way to a table of pre-integrated slabs: a row of the catalogue.
struct TableBuilder {
  std::string name = {};
  std::string_view summary = {};
  std::string_view source = {};
  /// Throws InputError as `check` does for the axes.
  Table<double> (*make)(const PiecewiseLinear&, const TableAxes&, Emission) = nullptr;
  /// What n x n entries take, in closed form; null where that depends on the transfer function, or was not asked.
  TableCost (*cost)(std::int64_t size) = nullptr;
  TableContent content = {};
};

}  // namespace raytruth
