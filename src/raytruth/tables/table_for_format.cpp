#include "raytruth/tables/table_for_format.hpp"

#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/fast_tables.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace raytruth {

namespace {

using MakeInBinary32 = void (*)(const PiecewiseLinear&, const TableAxes&, Emission, Table<float>&);

void make_subranges(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission, Table<float>& table) {
  build_subrange_table(sampled(transfer, axes, emission), axes, table);
}

void make_subranges_of_means(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                             Table<float>& table) {
  build_subrange_table(interval_means(transfer, axes, emission), axes, table);
}

template <std::size_t K>
void make_moment(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission, Table<float>& table) {
  std::array<Table<float>, 4> moments;
  build_moment_tables(interval_means(transfer, axes, emission), axes, moments);
  table = std::move(moments[K]);
}

/// The builders of the catalogue that have a way in binary32.
constexpr std::array<std::pair<std::string_view, MakeInBinary32>, 6> fast_builders{{
    {"subrange", make_subranges},
    {"subrange_means", make_subranges_of_means},
    {"moment_0", make_moment<0>},
    {"moment_1", make_moment<1>},
    {"moment_2", make_moment<2>},
    {"moment_3", make_moment<3>},
}};

auto fast_builder(const TableBuilder& builder) {
  return std::find_if(fast_builders.begin(), fast_builders.end(),
                      [&builder](const auto& row) { return row.first == builder.name; });
}

}  // namespace

bool is_made_in_binary32(const TableBuilder& builder, const PiecewiseLinear& transfer, const TableFormat& format) {
  const auto& points = transfer.points();
  return format.is_texel && fast_builder(builder) != fast_builders.end() &&
         std::all_of(points.begin(), points.end(),
                     [](const TransferPoint& point) { return point.optics.color.maxCoeff() <= 1; });
}

Table<double> table_for_format(const TableBuilder& builder, const PiecewiseLinear& transfer, const TableAxes& axes,
                               Emission emission, const TableFormat& format) {
  if (!is_made_in_binary32(builder, transfer, format)) return builder.make(transfer, axes, emission);
  Table<float> fast;
  fast_builder(builder)->second(transfer, axes, emission, fast);
  Table<double> table(axes);
  table.values.assign(fast.values.begin(), fast.values.end());
  return table;
}

}  // namespace raytruth
