#include "signals/trilinear.hpp"

#include "core/dispatch.hpp"
#include "signals/cell_walk.hpp"
#include "signals/tracing_error.hpp"

namespace raytruth {

namespace {

/// Eight values at the corners of a box, cut down to [begin, end] along the axis of the index's lowest bit, which
/// becomes the highest bit of the result's index: three cuts visit all axes and restore the order.
template <class Real>
std::array<Real, 8> cut(const std::array<Real, 8>& corners, const Real& begin, const Real& end) {
  std::array<Real, 8> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    result[i] = interpolate(corners[2 * i], corners[2 * i + 1], begin);
    result[i + 4] = interpolate(corners[2 * i], corners[2 * i + 1], end);
  }
  return result;
}

/// The cubic on the segment of a cell between two local points; see the header for the formula.
template <class Real>
Bernstein<3, Real> cell_cubic(const Grid& grid, const CellSegment<Real>& segment) {
  std::array<std::array<std::int64_t, 2>, 3> offset{};
  std::int64_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t cell = segment.cell[axis];
    offset[axis] = {std::max(cell, std::int64_t{0}) * stride, std::min(cell + 1, grid.size[axis] - 1) * stride};
    stride *= grid.size[axis];
  }
  const auto [x0, x1] = offset[0];
  const auto [y0, y1] = offset[1];
  const double* const low = grid.values.data() + offset[2][0];
  const double* const high = grid.values.data() + offset[2][1];
  std::array<Real, 8> corners{low[y0 + x0],  low[y0 + x1],  low[y1 + x0],  low[y1 + x1],
                              high[y0 + x0], high[y0 + x1], high[y1 + x0], high[y1 + x1]};
  for (std::size_t axis = 0; axis < 3; ++axis) corners = cut(corners, segment.begin[axis], segment.end[axis]);

  // As steps from the ends: constant data give constant coefficients, bit by bit.
  const Real p = corners[0];
  const Real q = corners[7];
  return {{p, p + ((corners[1] - p) + (corners[2] - p) + (corners[4] - p)) / 3,
           q + ((corners[6] - q) + (corners[5] - q) + (corners[3] - q)) / 3, q}};
}

}  // namespace

RAYTRUTH_DISPATCH
void trace_trilinear(const Grid& grid, const Ray& ray, Chain<3>& chain) {
  trace_cells(grid.size, ray, chain, [&grid](const CellWalk& walk) { return cell_cubic(grid, walk.segment()); });
}

Chain<3> trace_trilinear(const Grid& grid, const Ray& ray) {
  Chain<3> chain;
  trace_trilinear(grid, ray, chain);
  return chain;
}

RAYTRUTH_DISPATCH
SignalError trilinear_error(const Grid& grid, const Ray& ray, const Chain<3>& chain,
                            const std::vector<bool>& is_needless) {
  const Reconstruction trilinear{.margin = 0, .slope = 1};
  return tracing_error(grid, ray, chain, trilinear, is_needless,
                       [&grid](const CellSegment<DoubleDouble>& segment) { return cell_cubic(grid, segment); });
}

}  // namespace raytruth
