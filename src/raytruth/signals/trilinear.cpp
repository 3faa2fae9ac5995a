#include "raytruth/signals/trilinear.hpp"

#include "raytruth/core/dispatch.hpp"
#include "raytruth/core/double_double4.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/tracing_error.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace raytruth {

namespace {

/// The values at a cell's corners, x fastest.
std::array<double, 8> corners_of(const Grid& grid, const std::array<std::int64_t, 3>& cell) {
  std::array<std::array<std::int64_t, 2>, 3> offset{};
  std::int64_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    offset[axis] = {std::max(cell[axis], std::int64_t{0}) * stride,
                    std::min(cell[axis] + 1, grid.size[axis] - 1) * stride};
    stride *= grid.size[axis];
  }
  const auto [x0, x1] = offset[0];
  const auto [y0, y1] = offset[1];
  const double* const low = grid.values.data() + offset[2][0];
  const double* const high = grid.values.data() + offset[2][1];
  return {low[y0 + x0],  low[y0 + x1],  low[y1 + x0],  low[y1 + x1],
          high[y0 + x0], high[y0 + x1], high[y1 + x0], high[y1 + x1]};
}

/// Eight values at the corners of a box, cut down to [begin, end] along the axis of the index's lowest bit, which
/// becomes the highest bit of the result's index: three cuts visit all axes and restore the order.
std::array<double, 8> cut(const std::array<double, 8>& corners, double begin, double end) {
  std::array<double, 8> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    result[i] = interpolate(corners[2 * i], corners[2 * i + 1], begin);
    result[i + 4] = interpolate(corners[2 * i], corners[2 * i + 1], end);
  }
  return result;
}

/// The corners as numbers in 106 bits, cut in halves: a cut takes those of even and of odd index, and makes those below
/// 4 and those from there on.
struct Corners106 {
  DoubleDouble4 first;
  DoubleDouble4 second;

  [[nodiscard]] Corners106 cut(const DoubleDouble& begin, const DoubleDouble& end) const {
    const DoubleDouble4 difference = second - first;
    return {first + difference * begin, first + difference * end};
  }

  /// Turns halves by the highest bit of the index into halves by the lowest.
  [[nodiscard]] Corners106 by_lowest_bit() const {
    Corners106 result;
    for (int i = 0; i < 2; ++i) {
      result.first.high[i] = first.high[2 * i];
      result.first.low[i] = first.low[2 * i];
      result.second.high[i] = first.high[2 * i + 1];
      result.second.low[i] = first.low[2 * i + 1];
      result.first.high[i + 2] = second.high[2 * i];
      result.first.low[i + 2] = second.low[2 * i];
      result.second.high[i + 2] = second.high[2 * i + 1];
      result.second.low[i + 2] = second.low[2 * i + 1];
    }
    return result;
  }
};

/// The cubic on the segment of a cell between two local points.
Bernstein<3> cell_cubic(const Grid& grid, const CellSegment<double>& segment) {
  auto corners = corners_of(grid, segment.cell);
  for (std::size_t axis = 0; axis < 3; ++axis) corners = cut(corners, segment.begin[axis], segment.end[axis]);
  // Coefficients are steps from the ends, so that constant data give constant ones, bit by bit.
  const double p = corners[0];
  const double q = corners[7];
  return {{p, p + ((corners[1] - p) + (corners[2] - p) + (corners[4] - p)) / 3,
           q + ((corners[6] - q) + (corners[5] - q) + (corners[3] - q)) / 3, q}};
}

Bernstein<3, DoubleDouble> cell_cubic(const Grid& grid, const CellSegment<DoubleDouble>& segment) {
  const auto v = corners_of(grid, segment.cell);
  Corners106 corners{{{v[0], v[1], v[2], v[3]}, {}}, {{v[4], v[5], v[6], v[7]}, {}}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    corners = corners.by_lowest_bit().cut(segment.begin[axis], segment.end[axis]);
  // Both inner coefficients are computed side by side, by the formula above.
  const auto pair = [&](int i, int j) {
    const DoubleDouble a = i < 4 ? corners.first[i] : corners.second[i - 4];
    const DoubleDouble b = j < 4 ? corners.first[j] : corners.second[j - 4];
    return DoubleDouble4{{a.high, b.high, 0, 0}, {a.low, b.low, 0, 0}};
  };
  constexpr DoubleDouble third{0x1.5555555555555p-2, 0x1.5555555555555p-56};
  const DoubleDouble4 ends = pair(0, 7);
  const DoubleDouble4 inner = ends + ((pair(1, 6) - ends) + (pair(2, 5) - ends) + (pair(4, 3) - ends)) * third;
  return {{ends[0], inner[0], inner[1], ends[1]}};
}

constexpr Reconstruction trilinear{.margin = 0, .slope = 1};

}  // namespace

RAYTRUTH_DISPATCH
void trace_trilinear(const Grid& grid, const Ray& ray, Chain<3>& chain, Border border) {
  trace_cells(grid.size, border, ray, chain,
              [&grid](const CellWalk& walk) { return cell_cubic(grid, walk.segment()); });
}

Chain<3> trace_trilinear(const Grid& grid, const Ray& ray, Border border) {
  Chain<3> chain;
  trace_trilinear(grid, ray, chain, border);
  return chain;
}

RAYTRUTH_DISPATCH
SignalError trilinear_error(const Grid& grid, const Ray& ray, const Chain<3>& chain,
                            const std::vector<bool>& is_needless, const RayDisplacement& displacement, Border border) {
  return tracing_error(grid, border, ray, chain, trilinear, is_needless, displacement,
                       [&grid](const CellSegment<DoubleDouble>& segment) { return cell_cubic(grid, segment); });
}

PreciseChain<3> trace_trilinear_precisely(const Grid& grid, const Ray& ray, const RayDisplacement& displacement,
                                          Border border) {
  return trace_precisely<3>(grid, border, ray, trilinear, displacement,
                            [&grid](const CellSegment<DoubleDouble>& segment) { return cell_cubic(grid, segment); });
}

}  // namespace raytruth
