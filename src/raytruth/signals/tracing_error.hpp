#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/double_double.hpp"
#include "raytruth/core/double_double4.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/precise_chain.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/signals/ray_displacement.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/volume/grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace raytruth {

/// A ray at its exactly normalised direction D / |D|, as origin + lambda D in 106 bits: of its numbers only |D| is
/// irrational. D is scaled by a power of two. Operations on DoubleDouble being off by less than 2^-102 of their
/// results, lambda and what is proportional to it are off by less than `noise` of themselves.
struct ExactLine {
  static constexpr double noise = 0x1p-96;

  /// Throws InputError for a bad direction.
  ExactLine(const std::array<std::int64_t, 3>& grid_size, Border border, const Ray& ray);

  /// lambda at a t that counts from the entry into the clamped field.
  [[nodiscard]] DoubleDouble at(const DoubleDouble& t) const { return inside.begin + t * inverse_norm; }

  /// How far the end of a chain may be from the ray's own.
  [[nodiscard]] double length_error(const DoubleDouble& chain_end) const;

  std::array<std::int64_t, 3> size;
  std::array<double, 3> origin;
  std::array<double, 3> direction;  ///< D, its largest component in [1/2, 1)
  DoubleDouble norm;                ///< |D|
  DoubleDouble inverse_norm;
  Span inside;  ///< lambda in the clamped field
  double cut;   ///< Ray::length
};

/// The segment of a line between two lambda, in the coordinates of the cell around its middle, which it leaves at its
/// ends by no more than rounding, and by `displacement` along each axis: how far the line that is meant may be.
struct ExactSegment {
  ExactSegment(const ExactLine& line, const DoubleDouble& lambda_begin, const DoubleDouble& lambda_end,
               const std::array<double, 3>& displacement) {
    using Vector = DoubleDouble4::Vector;
    const Vector origin{line.origin[0], line.origin[1], line.origin[2], 0};
    const Vector direction{line.direction[0], line.direction[1], line.direction[2], 0};
    const DoubleDouble4 from = product(direction, lambda_begin);
    const DoubleDouble4 to = product(direction, lambda_end);
    const DoubleDouble4 middle = DoubleDouble4{origin, {}} + (from + to) * DoubleDouble(0.5);
    Vector low{};
    for (int axis = 0; axis < 3; ++axis)
      low[axis] =
          std::clamp(floor(middle[axis]), -1.0, static_cast<double>(line.size[static_cast<std::size_t>(axis)] - 1));
    // Places are counted from either border for itself, so that a line that starts on one is off by the noise of its
    // way only: sums are off by 2^-102 of their terms, and where these are of different size the sum is far from the
    // border.
    const DoubleDouble4 from_low = two_sum(origin, -low);
    const DoubleDouble4 from_high = two_sum(origin, -low - 1);
    const DoubleDouble4 begin = from_low + from;
    const DoubleDouble4 end = from_low + to;
    const Vector begin_of_high = (from_high + from).high;
    const Vector end_of_high = (from_high + to).high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto lane = static_cast<int>(axis);
      cell.cell[axis] = static_cast<std::int64_t>(low[lane]);
      cell.begin[axis] = begin[lane];
      cell.end[axis] = end[lane];
      if (line.direction[axis] == 0 && displacement[axis] == 0) continue;
      const double noise_of_way = ExactLine::noise * std::abs(to.high[lane]) + displacement[axis];
      noise[axis] = noise_of_way + ExactLine::noise;
      before[axis] = std::max(0.0, noise_of_way - std::min(begin.high[lane], end.high[lane]));
      behind[axis] = std::max(0.0, noise_of_way + std::max(begin_of_high[lane], end_of_high[lane]));
    }
  }

  CellSegment<DoubleDouble> cell{};
  std::array<double, 3> noise{};   ///< of begin and end
  std::array<double, 3> before{};  ///< how far it may lie before the cell
  std::array<double, 3> behind{};  ///< and behind it
};

/// The voxels on which a reconstruction depends in the cells that a segment reaches.
struct ReachedVoxels {
  std::array<double, 3> difference{};  ///< the largest of neighbours along each axis
  double magnitude = 0;                ///< the largest
  double first;                        ///< their first

  ReachedVoxels(const Grid& grid, const std::array<std::int64_t, 3>& first_voxel,
                const std::array<std::int64_t, 3>& last_voxel) {
    std::array<std::int64_t, 3> low{};
    std::array<std::int64_t, 3> high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::clamp(first_voxel[axis], std::int64_t{0}, grid.size[axis] - 1);
      high[axis] = std::clamp(last_voxel[axis], std::int64_t{0}, grid.size[axis] - 1);
    }
    first = grid.at(low[0], low[1], low[2]);
    // Voxels are taken row by row, without a branch for every one: this is much of the time that a bound takes.
    const std::int64_t next_row = grid.size[0];
    const std::int64_t next_plane = grid.size[0] * grid.size[1];
    const std::int64_t count = high[0] - low[0];
    const auto steps = [](const double* from, const double* to, std::int64_t last, double largest) {
      for (std::int64_t i = 0; i <= last; ++i) largest = std::max(largest, std::abs(to[i] - from[i]));
      return largest;
    };
    for (std::int64_t k = low[2]; k <= high[2]; ++k)
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        const double* const row = grid.values.data() + grid.index(low[0], j, k);
        for (std::int64_t i = 0; i <= count; ++i) magnitude = std::max(magnitude, std::abs(row[i]));
        difference[0] = steps(row, row + 1, count - 1, difference[0]);
        if (j < high[1]) difference[1] = steps(row, row + next_row, count, difference[1]);
        if (k < high[2]) difference[2] = steps(row, row + next_plane, count, difference[2]);
      }
  }

  [[nodiscard]] bool are_all(double value) const { return first == value && difference == std::array<double, 3>{}; }
};

/// What the bounds must know of a reconstruction.
struct Reconstruction {
  std::int64_t margin;  ///< voxels that a cell depends on beyond its own corners
  double slope;         ///< bounds |df/dx| in units of the largest difference of neighbouring voxels along x
};

/// What is known of the voxels around a segment of a line, and what follows from that.
struct SegmentVoxels {
  /// The bounds of `tracing_error` need all voxels of the cells that the segment reaches.
  SegmentVoxels(const Grid& its_grid, const ExactLine& its_line, const ExactSegment& its_segment,
                const Reconstruction& its_reconstruction, const std::array<double, 3>& its_displacement)
      : grid(its_grid),
        line(its_line),
        segment(its_segment),
        reconstruction(its_reconstruction),
        displacement(its_displacement),
        reached(voxels(segment.before, segment.behind, {})) {}

  /// Whether the scalar is `value`, exactly, in the cell. The last voxels along an axis have no weight where the line
  /// stays at the first of the cell.
  [[nodiscard]] bool are_all(double value) const { return that_count({}, {}).are_all(value); }

  /// Where it is: for how long the line may be among other voxels all the same.
  [[nodiscard]] double elsewhere(double value, const RayDisplacement& of_ray) const {
    if (that_count(segment.before, segment.behind).are_all(value)) return 0;
    double result = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double beyond = segment.before[axis] + segment.behind[axis];
      const double speed = std::abs(line.direction[axis]) - line.norm.high * of_ray.per_voxel[axis];
      if (beyond > 0)
        result += speed > 0 ? upwards * line.norm.high * beyond / speed : std::numeric_limits<double>::infinity();
    }
    return result;
  }

  /// How far the polynomial of the cell, exact for the segment, may be from the scalar.
  [[nodiscard]] double error() const {
    constexpr double value_noise = 0x1p-92;
    double misplaced = 0;
    double growth = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double overshoot = std::max(segment.before[axis], segment.behind[axis]);
      misplaced += (segment.noise[axis] + 2 * overshoot) * reconstruction.slope * reached.difference[axis];
      growth *= 1 + 2 * overshoot;
    }
    return growth * growth * growth * (misplaced + value_noise * reached.magnitude);
  }

  // It makes up for the rounding of the bounds themselves, sums of some twenty terms >= 0.
  static constexpr double upwards = 1 + 0x1p-46;

 private:
  [[nodiscard]] ReachedVoxels voxels(const std::array<double, 3>& before, const std::array<double, 3>& behind,
                                     const std::array<bool, 3>& is_at_first) const {
    std::array<std::int64_t, 3> first = segment.cell.cell;
    std::array<std::int64_t, 3> last = segment.cell.cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] -= reconstruction.margin + static_cast<std::int64_t>(std::ceil(before[axis]));
      last[axis] +=
          (is_at_first[axis] ? 0 : 1) + reconstruction.margin + static_cast<std::int64_t>(std::ceil(behind[axis]));
    }
    return {grid, first, last};
  }
  [[nodiscard]] ReachedVoxels that_count(const std::array<double, 3>& before,
                                         const std::array<double, 3>& behind) const {
    std::array<bool, 3> is_at_first{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      is_at_first[axis] = line.direction[axis] == 0 && displacement[axis] == 0 &&
                          segment.cell.begin[axis] == DoubleDouble(0) && segment.cell.end[axis] == DoubleDouble(0);
    return voxels(before, behind, is_at_first);
  }

  const Grid& grid;
  const ExactLine& line;
  const ExactSegment& segment;
  const Reconstruction& reconstruction;
  const std::array<double, 3>& displacement;
  ReachedVoxels reached;
};

/// How far the ray that is meant may be from the one at hand, t voxels behind the entry.
inline std::array<double, 3> displacement_at(const RayDisplacement& displacement, double t) {
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] = displacement.at_entry[axis] + t * displacement.per_voxel[axis];
  return result;
}

/// Bounds on |s(t) - chain(t)|, s(t) = f(x(t)) the clamped reconstruction f along the ray at its exact direction,
/// however the chain was made. `exact(segment)` gives the Bernstein coefficients of f in a cell, rounded by less than
/// 2^-92 of the largest voxel.
///
/// For a piece take any cell, here the one around its middle, and continue its polynomial f_c beyond it. With y the
/// point of the cell nearest to x,
///     |f(x) - f_c(x)| <= |f(x) - f(y)| + |f_c(y) - f_c(x)| <= 2 sum_axes overshoot slope,
/// f being continuous: overshoot is how far x(t) leaves the cell, slope bounds the derivative in all cells reached.
/// Continuing cubics by e beyond [0, 1] multiplies their bounds by (1 + 2 e)^3 per axis. |f_c(x(t)) - chain(t)| is at
/// most the largest difference of Bernstein coefficients, and misplacing the segment's ends by `noise` changes these,
/// as values of polar forms, by at most sum_axes noise slope.
///
/// Zero, exactly, where the chain is constant and the voxels of the cell are equal. If the neighbours are not, x(t) may
/// be there for a moment at the piece's ends: that goes into `unclaimed`, unless the moment may be as long as the
/// piece.
///
/// The line that is meant may be displaced against the ray: that is one more noise of its ends, and of its length.
///
/// chain(t) may be read with u = (t - start) / length, and with u from 0 to 1 between start and end_of.
///
/// Nothing is computed for pieces of which `is_needless` says so: their bounds are 0 and mean nothing.
template <int Degree, class Exact>
SignalError tracing_error(const Grid& grid, Border border, const Ray& ray, const Chain<Degree>& chain,
                          const Reconstruction& reconstruction, const std::vector<bool>& is_needless,
                          const RayDisplacement& displacement, Exact&& exact) {
  constexpr double upwards = SegmentVoxels::upwards;
  const ExactLine line(grid.size, border, ray);
  SignalError error{.of_pieces = {}, .of_length = line.length_error(chain.end) + displacement.of_length};
  error.of_pieces.reserve(chain.pieces.size());
  DoubleDouble lambda_end = line.at(0.0);
  for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
    const auto& piece = chain.pieces[i];
    const auto& b = piece.polynomial.coefficients;
    const DoubleDouble lambda_begin = lambda_end;
    lambda_end = line.at(chain.end_of(i));
    if (!is_needless.empty() && is_needless[i]) {
      error.of_pieces.push_back(0);
      continue;
    }
    const std::array<double, 3> displaced = displacement_at(displacement, chain.end_of(i).high);
    const ExactSegment segment(line, lambda_begin, lambda_end, displaced);
    const SegmentVoxels voxels(grid, line, segment, reconstruction, displaced);
    double step = 0;
    for (std::size_t k = 0; k < Degree; ++k) step = std::max(step, std::abs(b[k + 1] - b[k]));
    if (step == 0 && voxels.are_all(b[0])) {
      const double elsewhere = voxels.elsewhere(b[0], displacement);
      if (elsewhere <= piece.length) {
        error.of_pieces.push_back(0);
        error.unclaimed += elsewhere;
        continue;
      }
    }

    const auto truth = exact(segment.cell);
    double difference = 0;
    for (std::size_t k = 0; k <= Degree; ++k)
      difference = std::max(difference, std::abs(static_cast<double>(truth.coefficients[k] - b[k])));
    const double other_length = std::abs(static_cast<double>(chain.end_of(i) - piece.start - piece.length));
    const double stretch = Degree * step * other_length / piece.length;
    error.of_pieces.push_back(upwards * (difference + stretch + voxels.error() + std::numeric_limits<double>::min()));
  }
  return error;
}

/// The ray at its exactly normalised direction in 106 bits, cut at the borders of cells as a chain is. Bounds as those
/// of `tracing_error`, of which only those of 106 bits are left, and the displacement.
template <int Degree, class Exact>
PreciseChain<Degree> trace_precisely(const Grid& grid, Border border, const Ray& ray,
                                     const Reconstruction& reconstruction, const RayDisplacement& displacement,
                                     Exact&& exact) {
  const ExactLine line(grid.size, border, ray);
  PreciseChain<Degree> chain;
  if (!(line.inside.begin < line.inside.end) || ray.length == 0) return chain;
  DoubleDouble way = line.inside.end - line.inside.begin;
  if (std::isfinite(ray.length)) way = std::min(way, line.inverse_norm * ray.length);
  // As in `trace_cells`.
  const double tie = 0x1p-98 * (std::abs(line.inside.begin.high) + way.high);
  CellWalk walk(grid.size, line.origin, line.direction, line.inside.begin);
  DoubleDouble begin;
  while (begin < way) {
    const DoubleDouble end = std::min(walk.crossing(), way);
    walk.finish(end, tie);
    if (static_cast<double>(end - begin) > tie) {
      const std::array<double, 3> displaced = displacement_at(displacement, static_cast<double>(end * line.norm));
      const ExactSegment segment(line, line.inside.begin + begin, line.inside.begin + end, displaced);
      const SegmentVoxels voxels(grid, line, segment, reconstruction, displaced);
      auto& piece = chain.pieces.emplace_back();
      const DoubleDouble length = (end - begin) * line.norm;
      piece.length = static_cast<double>(length);
      piece.extent = length;
      piece.polynomial = exact(segment.cell);
      piece.error = SegmentVoxels::upwards * (voxels.error() + std::numeric_limits<double>::min());
      const DoubleDouble first = piece.polynomial.coefficients[0];
      if (first.low == 0 && voxels.are_all(first.high)) {
        const double elsewhere = voxels.elsewhere(first.high, displacement);
        if (elsewhere <= piece.length) {
          piece.polynomial.coefficients.fill(first);
          piece.error = 0;
          chain.unclaimed += elsewhere;
        }
      }
      chain.length += length;
      begin = end;
    }
    if (end == way) break;
    walk.advance();
  }
  chain.of_length = line.length_error(chain.length) + displacement.of_length;
  return chain;
}

}  // namespace raytruth
