#include "raytruth/tables/cell_table.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/look_up.hpp"
#include "raytruth/tables/subrange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

/// In place of 0, where colour over opacity is a limit: it is off by no more than the depth of such a slab.
constexpr double next_to_nothing = 0x1p-24;

Vec4 slice_at(const CellTable& table, std::size_t slice, double front, double back) {
  const Table<double>& of = table.slices[slice];
  return bilinear<double>(of.axes, [&of](std::size_t i, std::size_t j) -> Vec4 { return of.at(i, j); }, {front, back});
}

double mean_at(const CellTable& table, double front, double back) {
  const TableAxes& axes = table.slices.front().axes;
  const auto entry = [&](std::size_t i, std::size_t j) -> Vec4 {
    return Vec4::Constant(table.mean_extinctions[j * axes.size + i]);
  };
  return bilinear<double>(axes, entry, {front, back})[3];
}

}  // namespace

std::size_t CellTable::numbers() const {
  const std::size_t entries = slices.front().axes.size * slices.front().axes.size;
  // The slab of no length is no memory.
  const std::size_t kept = slices.size() - (axis == CellTableAxis::mean_depth ? 0 : 1);
  return axis == CellTableAxis::mean_depth ? entries * (3 * kept + 1) : entries * 4 * kept;
}

std::vector<double> cell_table_distances(CellTableAxis axis, std::size_t count, double longest) {
  if (count < 2) throw InputError(fmt::format("found {} distances; at least 2 are allowed", count));
  std::vector<double> distances{0};
  const auto last = static_cast<int>(count) - 1;
  const bool is_uniform = axis == CellTableAxis::uniform || axis == CellTableAxis::mean_depth;
  if (axis == CellTableAxis::printed) {
    for (int j = -7; j <= 1; ++j) distances.push_back(std::ldexp(1.0, j));
  } else {
    for (int i = 1; i <= last; ++i)
      distances.push_back(is_uniform ? longest * i / last : std::ldexp(longest, i - last));
  }
  return distances;
}

CellTable exact_cell_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                           CellTableAxis axis, const std::vector<double>& distances) {
  CellTable table{.axis = axis, .distances = distances, .slices = {}, .mean_extinctions = {}};
  for (const double distance : distances) {
    TableAxes of_slice = axes;
    of_slice.length = distance > 0 ? distance : next_to_nothing * distances.back();
    table.slices.push_back(exact_table(transfer, of_slice, emission));
    if (distance == 0 && axis != CellTableAxis::mean_depth)
      std::fill(table.slices.back().values.begin(), table.slices.back().values.end(), 0.0);
  }
  if (axis == CellTableAxis::mean_depth)
    for (std::size_t back = 0; back < axes.size; ++back)
      for (std::size_t front = 0; front < axes.size; ++front)
        table.mean_extinctions.push_back(mean_extinction(transfer, axes.scalar(front), axes.scalar(back)));
  return table;
}

Vec4 look_up(const CellTable& table, double front, double back, double length) {
  const auto& distances = table.distances;
  const double within = std::clamp(length, distances.front(), distances.back());
  const auto above = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      std::upper_bound(distances.begin(), distances.end(), within) - distances.begin(), 1, std::ssize(distances) - 1));
  const double low = distances[above - 1];
  const double high = distances[above];
  const bool is_in_logarithm = low > 0 && table.axis == CellTableAxis::powers_of_two_log;
  const double share = is_in_logarithm ? std::log(within / low) / std::log(high / low) : (within - low) / (high - low);
  const Vec4 first = slice_at(table, above - 1, front, back);
  const Vec4 second = slice_at(table, above, front, back);
  if (table.axis != CellTableAxis::mean_depth) return first + share * (second - first);
  const auto over_opacity = [](const Vec4& slab) -> Vec4 { return slab[3] > 0 ? Vec4(slab / slab[3]) : Vec4(slab); };
  const Vec4 color = over_opacity(first) + share * (over_opacity(second) - over_opacity(first));
  const double opacity = -std::expm1(-within * mean_at(table, front, back));
  Vec4 slab = opacity * color;
  slab[3] = opacity;
  return slab;
}

double mean_extinction(const PiecewiseLinear& transfer, double front, double back) {
  const double low = std::min(front, back);
  const double high = std::max(front, back);
  if (low == high) return transfer.at(front).extinction;
  double sum = 0;
  double at = low;
  double extinction = transfer.at(low).extinction;
  for (const TransferPoint& point : transfer.points()) {
    if (point.s < low) continue;
    if (point.s >= high) break;
    sum += (point.s - at) * (extinction + point.optics.extinction) / 2;
    at = point.s;
    extinction = point.optics.extinction;
  }
  const double last = transfer.before(high).extinction;
  return (sum + (high - at) * (extinction + last) / 2) / (high - low);
}

TableCost brute_force_cell_table_cost(std::int64_t size, std::int64_t distances) {
  const TableCost one = brute_force_cost(size);
  return {.composites = distances * one.composites, .exponentials = distances * one.exponentials};
}

TableCost subrange_cell_table_cost(std::int64_t size, std::int64_t distances) {
  const TableCost one = subrange_cost(size);
  return {.composites = distances * one.composites, .exponentials = distances * one.exponentials};
}

}  // namespace raytruth
