#include "render/cell_march.hpp"

#include "core/dispatch.hpp"
#include "core/error.hpp"
#include "render/lanes4.hpp"
#include "rules/rules.hpp"
#include "signals/cell_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

namespace {

// So many cells are integrated at once, from so many voxels of a ray; it may become opaque in between.
constexpr std::size_t cells_at_once = 64;
constexpr double voxels_at_once = 64;

/// The cubic along the diagonal of a box [p, q] in a cell, from the cell's eight voxels: `trace_trilinear` says why.
Bernstein<3> cell_cubic(const PaddedVoxels& voxels, const Int4& cell, const Double4& p, const Double4& q) {
  const auto [y, z] = voxels.stride();
  const float* const corner = voxels.at(cell[0], cell[1], cell[2]);
  const Double4 low = __builtin_convertvector(load2(corner, corner + y), Double4);
  const Double4 high = __builtin_convertvector(load2(corner + z, corner + y + z), Double4);
  // x0y0 x1y0 x0y1 x1y1, at either end along z
  const Double4 at_p = low + p[2] * (high - low);
  const Double4 at_q = low + q[2] * (high - low);
  // p and q along z, at x0 and x1
  const Double4 y0{at_p[0], at_q[0], at_p[1], at_q[1]};
  const Double4 y1{at_p[2], at_q[2], at_p[3], at_q[3]};
  const Double4 of_p = y0 + p[1] * (y1 - y0);
  const Double4 of_q = y0 + q[1] * (y1 - y0);
  // yz: pp pq qp qq
  const Double4 x0{of_p[0], of_p[1], of_q[0], of_q[1]};
  const Double4 x1{of_p[2], of_p[3], of_q[2], of_q[3]};
  const Double4 front = x0 + p[0] * (x1 - x0);
  const Double4 back = x0 + q[0] * (x1 - x0);
  return {{front[0], (back[0] + front[1] + front[2]) / 3, (back[1] + back[2] + front[3]) / 3, back[3]}};
}

}  // namespace

CellMarch::CellMarch(const Grid& grid, const PiecewiseLinear& transfer, Emission emission, double opaque)
    : size_(grid.size), voxels_(grid), clear_(transfer, emission), opaque_(opaque) {
  const auto [low, high] = grid.range();
  const double largest = std::max(-low, high);
  if (largest > std::numeric_limits<float>::max())
    throw InputError(fmt::format("voxels up to {}; those of binary32 are allowed", largest));
}

/// Walks from `begin` to `end`, in voxels along the ray, and keeps the cells that are not clear. All axes go through
/// the same arithmetic in every step, as in CellWalk.
RAYTRUTH_DISPATCH
void CellRay::collect(const PixelRay& pixel, double begin, double end) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr Double4 zero{};
  constexpr Double4 one{1, 1, 1, 1};
  Double4 way{};
  Double4 inverse{};  // 0 along axes on which nothing moves
  Double4 offset{};   // from the low corner of the cell, of padded voxels, to the ray's origin
  Double4 cell{};
  Double4 exit{};  // 0 or 1, where the ray leaves the cell
  Double4 step{};
  Double4 never{0, 0, 0, infinity};  // added to crossings
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    way[i] = pixel.ray.direction[axis];
    const double padded = pixel.ray.origin[axis] + 1;
    cell[i] = std::clamp(std::floor(padded + begin * way[i]), 0.0, static_cast<double>(march_.size()[axis]));
    offset[i] = padded - cell[i];
    exit[i] = way[i] > 0 ? 1 : 0;
    step[i] = way[i] > 0 ? 1 : -1;
    inverse[i] = way[i] != 0 ? 1 / way[i] : 0;
    never[i] = way[i] != 0 ? 0 : infinity;
  }
  const auto go_to = [&](double t, Double4& local) {
    local = offset + t * way;
    local = local > zero ? local : zero;
    local = local < one ? local : one;
  };
  Double4 here{};
  go_to(begin, here);
  for (double t = begin; t < end;) {
    const Double4 crossing = (exit - offset) * inverse + never;
    const double next = std::min(std::min(crossing[0], crossing[1]), std::min(crossing[2], end));
    const auto crosses = crossing == next + zero;
    Double4 there{};
    go_to(next, there);
    there = crosses ? exit : there;
    if (next > t) {
      const Bernstein<3> cubic = cell_cubic(march_.voxels(), __builtin_convertvector(cell, Int4), here, there);
      const auto& b = cubic.coefficients;
      const double low = std::min(std::min(b[0], b[1]), std::min(b[2], b[3]));
      const double high = std::max(std::max(b[0], b[1]), std::max(b[2], b[3]));
      if (!march_.clear().contain(low, high)) {
        const double length = (next - t) * pixel.length_unit;
        visible_.pieces.push_back({visible_.end, length, cubic});
        visible_.end = visible_.end.high + length;
      }
      t = next;
    }
    const Double4 moved = crosses ? step : zero;
    cell += moved;
    offset -= moved;
    here = crosses ? one - exit : there;
  }
}

/// Puts what was collected behind `sum`; one cell after the other where the ray may have to end behind any of them.
void CellRay::composite(Eigen::Array4d& sum) {
  const auto add = [&](const Chain<3>& cells) {
    const Certified slab = integrate_(cells);
    sum = Rules<double>{}.over(sum, {slab.color[0], slab.color[1], slab.color[2], slab.opacity});
  };
  if (march_.opaque() >= 1)
    add(visible_);
  else
    for (std::size_t i = 0; i < visible_.pieces.size() && sum[3] < march_.opaque(); ++i)
      add({.pieces = {visible_.pieces[i]}, .end = visible_.end_of(i)});
  visible_.pieces.clear();
  visible_.end = 0.0;
}

Eigen::Array4d CellRay::operator()(const PixelRay& pixel, const std::optional<std::span<const RayPart>>& parts) {
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  const Stretch inside = clip(march_.size(), pixel.ray.origin, pixel.ray.direction);
  if (!(inside.begin < inside.end)) return sum;
  const auto entry = static_cast<double>(inside.begin);
  const RayPart everything{0, static_cast<double>(inside.end - inside.begin)};
  for (const RayPart& part : parts.value_or(std::span(&everything, 1)))
    for (double begin = part.begin; begin < part.end; begin += voxels_at_once) {
      collect(pixel, entry + begin, entry + std::min(begin + voxels_at_once, part.end));
      if (visible_.pieces.size() < cells_at_once) continue;
      composite(sum);
      if (sum[3] >= std::min(march_.opaque(), 1.0)) return sum;
    }
  composite(sum);
  return sum;
}

}  // namespace raytruth
