#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/double_double.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/ray.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace raytruth {

/// One number for each axis; a fourth, idle one fills a register.
struct alignas(32) PerAxis {
  std::array<double, 4> lane{};
  double& operator[](std::size_t axis) { return lane[axis]; }
  double operator[](std::size_t axis) const { return lane[axis]; }
};

/// A segment through a cell: from `begin` to `end` in the cell's own coordinates, [0, 1] on every axis.
template <class Real>
struct CellSegment {
  std::array<std::int64_t, 3> cell;  ///< of the voxel at the low end; -1 in the clamped half before the first one
  std::array<Real, 3> begin;
  std::array<Real, 3> end;
};

/// The walk from cell to cell. Cell i of an axis spans the voxel centres i and i + 1; cells -1 and n - 1 are the
/// clamped halves at the ends. All axes go through the same arithmetic in every step, whichever border is crossed: a
/// branch for each axis would be mispredicted in every second cell.
class CellWalk {
 public:
  CellWalk(const std::array<std::int64_t, 3>& size, const std::array<double, 3>& origin,
           const std::array<double, 3>& direction, const DoubleDouble& entry) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const DoubleDouble start = DoubleDouble(origin[axis]) + entry * direction[axis];
      start_high_[axis] = start.high;
      start_low_[axis] = start.low;
      direction_[axis] = direction[axis];
      moves_[axis] = direction[axis] != 0 ? 1 : 0;
      inverse_[axis] = direction[axis] != 0 ? 1 / direction[axis] : 0;
      exit_[axis] = direction[axis] > 0 ? 1 : 0;
      cell_[axis] = std::clamp(floor(start), -1.0, static_cast<double>(size[axis] - 1));
    }
    enter_cells();
    finish(0.0, 0);
    begin_ = end_;
  }

  /// Where the ray leaves the current cell; infinite if it does not.
  [[nodiscard]] DoubleDouble crossing() const {
    DoubleDouble first = crossing_of(0);
    for (std::size_t axis = 1; axis < 3; ++axis) first = std::min(first, crossing_of(axis));
    return first;
  }

  /// Ends the current piece at t: on the border of the axes whose crossing is not later by more than `tolerance`, at
  /// the coordinate inside the cell, local_start + t direction, clamped against rounding, of the others. The sum is not
  /// normalised on the way, its terms being added from the smallest: all that is wanted is the nearest binary64 number.
  void finish(const DoubleDouble& t, double tolerance) {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const double late = (crossing_high_[axis] - t.high) + (crossing_low_[axis] - t.low);
      crosses_[axis] = late <= tolerance ? 1 : 0;
      const DoubleDouble product = two_product(t.high, direction_[axis]);
      const DoubleDouble sum = two_sum(local_high_[axis], product.high);
      const double rest = sum.low + (product.low + (t.low * direction_[axis] + local_low_[axis]));
      const double local = std::min(std::max(sum.high + rest, 0.0), 1.0);
      end_[axis] = late <= tolerance ? exit_[axis] : local;
    }
  }

  /// Goes on from where the piece ended.
  void advance() {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      // The next cell is entered at 0 where this one was left at 1, and the other way round.
      cell_[axis] += crosses_[axis] * (2 * exit_[axis] - 1);
      begin_[axis] = crosses_[axis] != 0 ? 1 - exit_[axis] : end_[axis];
    }
    enter_cells();
  }

  /// The current piece.
  [[nodiscard]] CellSegment<double> segment() const {
    CellSegment<double> result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.cell[axis] = static_cast<std::int64_t>(cell_[axis]);
      result.begin[axis] = begin_[axis];
      result.end[axis] = end_[axis];
    }
    return result;
  }

 private:
  [[nodiscard]] DoubleDouble crossing_of(std::size_t axis) const { return {crossing_high_[axis], crossing_low_[axis]}; }

  /// local_start = start - cell, and the crossing, (exit - local_start) / direction, by a Newton step from the rounded
  /// quotient.
  void enter_cells() {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const DoubleDouble local = two_sum(start_high_[axis], -cell_[axis]);
      const DoubleDouble local_start = fast_two_sum(local.high, local.low + start_low_[axis]);
      local_high_[axis] = local_start.high;
      local_low_[axis] = local_start.low;
      const DoubleDouble distance = two_sum(exit_[axis], -local_start.high);
      const double quotient = distance.high * inverse_[axis];
      const double remainder = std::fma(-quotient, direction_[axis], distance.high) + (distance.low - local_start.low);
      const DoubleDouble crossing = fast_two_sum(quotient, remainder * inverse_[axis]);
      crossing_high_[axis] = moves_[axis] != 0 ? crossing.high : std::numeric_limits<double>::infinity();
      crossing_low_[axis] = moves_[axis] != 0 ? crossing.low : 0;
    }
  }

  PerAxis start_high_, start_low_, direction_, inverse_, moves_, exit_, cell_;
  PerAxis local_high_, local_low_, crossing_high_, crossing_low_, crosses_, begin_, end_;
};

/// The span of the line origin + t direction inside of a volume, [-margin_of(border), size - 1 + margin_of(border)] on
/// every axis; none where its end is not behind its begin.
struct Span {
  DoubleDouble begin;
  DoubleDouble end = std::numeric_limits<double>::infinity();
};
Span clip(const std::array<std::int64_t, 3>& size, Border border, const std::array<double, 3>& origin,
          const std::array<double, 3>& direction);

/// The chain along a ray through a grid: `cell_polynomial(walk)` gives the signal on the segment through the walk's
/// current cell. The ray is clipped to the clamped field, and t = 0 where it enters, or at an origin inside; a miss is
/// the chain without pieces. `chain` is overwritten and keeps its memory. Throws InputError for a bad direction, a
/// negative length, or an origin farther than 2^40 voxels: from there, 106 bits would no longer give cell-local
/// coordinates to the last bit.
template <int Degree, class CellPolynomial>
void trace_cells(const std::array<std::int64_t, 3>& size, Border border, const Ray& ray, Chain<Degree>& chain,
                 CellPolynomial&& cell_polynomial) {
  chain.pieces.clear();
  chain.end = 0.0;
  const auto direction = unit_direction(ray.direction);
  for (const double x : ray.origin)
    if (!(std::abs(x) <= 0x1p40))
      throw InputError(fmt::format("origin coordinate {}; magnitudes up to 2^40 voxels are allowed", x));
  if (!(ray.length >= 0)) throw InputError(fmt::format("length {}; numbers >= 0 are allowed", ray.length));

  const Span span = clip(size, border, ray.origin, direction);
  if (!(span.begin < span.end) || ray.length == 0) return;
  const DoubleDouble end = std::min(span.end - span.begin, DoubleDouble(ray.length));
  // Crossings that differ by less than the rounding of a double-double abscissa are one crossing.
  const double tie = 0x1p-98 * (std::abs(span.begin.high) + end.high);

  CellWalk walk(size, ray.origin, direction, span.begin);
  DoubleDouble t;
  while (t < end) {
    const DoubleDouble next = std::min(walk.crossing(), end);
    walk.finish(next, tie);
    // A border met at the start, or twice within rounding, makes no piece.
    const auto length = static_cast<double>(next - t);
    if (length > tie) {
      chain.pieces.push_back({t, length, cell_polynomial(walk)});
      t = next;
    }
    if (next == end) break;
    walk.advance();
  }
  if (!chain.pieces.empty()) chain.end = end;
}

}  // namespace raytruth
