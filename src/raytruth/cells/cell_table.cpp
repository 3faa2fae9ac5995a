#include "raytruth/cells/cell_table.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/discrete_transfer.hpp"
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

bool has_mean_depth(CellTableAxis axis) { return axis == CellTableAxis::mean_depth || axis == CellTableAxis::slope; }

Vec4 slice_at(const CellTable& table, std::size_t slice, double front, double back) {
  const Table<double>& of = table.slices[slice];
  return bilinear<double>(of.axes, [&of](std::size_t i, std::size_t j) -> Vec4 { return of.at(i, j); }, {front, back});
}

Table<double> slice_of(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                       CellTableEntries entries) {
  if (entries == CellTableEntries::brute_force)
    return brute_force_table<double>(interval_means(transfer, axes, emission), axes);
  if (entries == CellTableEntries::subrange)
    return subrange_table<double>(interval_means(transfer, axes, emission), axes);
  return exact_table(transfer, axes, emission);
}

/// The table of `steps` steps from that of one and that of one less.
Table<double> incremental_table(const Table<double>& one, const Table<double>& before, std::size_t steps) {
  Table<double> table(before.axes);
  for (std::size_t back = 0; back < before.axes.size; ++back)
    for (std::size_t front = 0; front < before.axes.size; ++front) {
      const double between = static_cast<double>(front) +
                             (static_cast<double>(back) - static_cast<double>(front)) / static_cast<double>(steps);
      const auto middle = static_cast<std::size_t>(std::lround(between));
      const Vec4 first = one.at(front, middle);
      const Vec4 rest = before.at(middle, back);
      table.set(front, back, Rules<double>{}.over(first, rest));
    }
  return table;
}

/// Slabs that cross the difference of their scalars in `axes.length` for every 1 of it; those of one scalar are next
/// to nothing, so that colour over opacity is that of a homogeneous slab.
Table<double> slope_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission) {
  Table<double> table(axes);
  const auto last = static_cast<double>(axes.size - 1);
  const double step = axes.length * (axes.high - axes.low) / last;
  std::vector<Vec4> up;
  std::vector<Vec4> down;
  for (std::size_t i = 0; i < axes.size; ++i) {
    const std::size_t low = std::min(i, axes.size - 2);
    const TableAxes pair{.size = 2, .low = axes.scalar(low), .high = axes.scalar(low + 1), .length = step};
    const Table<double> slabs = exact_table(transfer, pair, emission);
    up.emplace_back(slabs.at(0, 1));
    down.emplace_back(slabs.at(1, 0));
    TableAxes thin = pair;
    thin.length = next_to_nothing * step;
    const std::size_t end = i - low;
    table.set(i, i, exact_table(transfer, thin, emission).at(end, end));
  }
  Rules<double> rules;
  for (std::size_t front = 0; front < axes.size; ++front) {
    Vec4 slab = Vec4::Zero();
    for (std::size_t back = front + 1; back < axes.size; ++back) {
      slab = rules.over(slab, up[back - 1]);
      table.set(front, back, slab);
    }
    slab = Vec4::Zero();
    for (std::size_t back = front; back-- > 0;) {
      slab = rules.over(slab, down[back]);
      table.set(front, back, slab);
    }
  }
  return table;
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
  const std::size_t kept = slices.size() - (has_mean_depth(axis) ? 0 : 1);
  return has_mean_depth(axis) ? entries * (3 * kept + 1) : entries * 4 * kept;
}

std::vector<double> cell_table_distances(CellTableAxis axis, std::size_t count, double longest) {
  const std::size_t fewest = axis == CellTableAxis::slope ? 3 : 2;
  if (count < fewest) throw InputError(fmt::format("found {} distances; at least {} are allowed", count, fewest));
  std::vector<double> distances{0};
  const auto last = static_cast<int>(count) - 1;
  const bool is_uniform = axis == CellTableAxis::uniform || axis == CellTableAxis::mean_depth;
  if (axis == CellTableAxis::printed) {
    for (int j = -7; j <= 1; ++j) distances.push_back(std::ldexp(1.0, j));
  } else if (axis == CellTableAxis::slope) {
    constexpr double shortest = 1.0 / 64;
    constexpr double steepest = 1024;
    for (int i = 0; i < last; ++i)
      distances.push_back(longest * shortest * std::pow(steepest / shortest, static_cast<double>(i) / (last - 1)));
  } else {
    for (int i = 1; i <= last; ++i)
      distances.push_back(is_uniform ? longest * i / last : std::ldexp(longest, i - last));
  }
  return distances;
}

CellTable cell_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission, CellTableAxis axis,
                     const std::vector<double>& distances, CellTableEntries entries) {
  if (entries != CellTableEntries::exact &&
      (axis == CellTableAxis::slope || (entries == CellTableEntries::incremental && axis != CellTableAxis::uniform)))
    throw InputError(fmt::format("found {} entries along {}; exact ones are allowed",
                                 cell_table_entries_names[static_cast<std::size_t>(entries)],
                                 cell_table_axis_names[static_cast<std::size_t>(axis)]));
  CellTable table{.axis = axis, .distances = distances, .slices = {}, .mean_extinctions = {}};
  for (std::size_t k = 0; k < distances.size(); ++k) {
    TableAxes of_slice = axes;
    of_slice.length = distances[k] > 0 ? distances[k] : next_to_nothing * distances.back();
    if (axis == CellTableAxis::slope)
      table.slices.push_back(slope_table(transfer, of_slice, emission));
    else if (entries == CellTableEntries::incremental && k > 1)
      table.slices.push_back(incremental_table(table.slices[1], table.slices[k - 1], k));
    else
      table.slices.push_back(slice_of(transfer, of_slice, emission, entries));
    if (distances[k] == 0 && !has_mean_depth(axis))
      std::fill(table.slices.back().values.begin(), table.slices.back().values.end(), 0.0);
  }
  if (has_mean_depth(axis))
    for (std::size_t back = 0; back < axes.size; ++back)
      for (std::size_t front = 0; front < axes.size; ++front)
        table.mean_extinctions.push_back(mean_extinction(transfer, axes.scalar(front), axes.scalar(back)));
  return table;
}

Vec4 look_up(const CellTable& table, double front, double back, double length) {
  const auto& distances = table.distances;
  const bool is_slope = table.axis == CellTableAxis::slope;
  // A slab of one scalar is as steep as can be.
  const double distance = is_slope ? (front == back ? distances.back() : length / std::abs(back - front)) : length;
  const double within = std::clamp(distance, distances.front(), distances.back());
  const auto above = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      std::upper_bound(distances.begin(), distances.end(), within) - distances.begin(), 1, std::ssize(distances) - 1));
  const double low = distances[above - 1];
  const double high = distances[above];
  const bool is_in_logarithm = low > 0 && (table.axis == CellTableAxis::powers_of_two_log || is_slope);
  const double share = is_in_logarithm ? std::log(within / low) / std::log(high / low) : (within - low) / (high - low);
  const Vec4 first = slice_at(table, above - 1, front, back);
  const Vec4 second = slice_at(table, above, front, back);
  if (!has_mean_depth(table.axis)) return first + share * (second - first);
  const auto over_opacity = [](const Vec4& slab) -> Vec4 { return slab[3] > 0 ? Vec4(slab / slab[3]) : Vec4(slab); };
  const Vec4 color = over_opacity(first) + share * (over_opacity(second) - over_opacity(first));
  const double opacity = -std::expm1(-(is_slope ? length : within) * mean_at(table, front, back));
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
