#include "raytruth/render/techniques/cell_march.hpp"

#include "raytruth/core/dispatch.hpp"
#include "raytruth/core/double_double.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/kernels/cell_kernels.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/render/techniques/lanes4.hpp"
#include "raytruth/render/techniques/skipped_space.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/transfer/emission.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

// So many cells are integrated at once, from so many voxels of a ray; it may become opaque in between.
constexpr std::size_t cells_at_once = 64;
constexpr double voxels_at_once = 64;

constexpr double deepest = 16;  // halved until they are thick; deeper ones are the reference's

constexpr double largest_voxel = 0x1p500;  // as RayIntegral has it for points: squares of larger ones overflow

constexpr double faintest = 0x1p-30;  // transmittance behind which nothing counts

/// The cubic along the diagonal of a box [p, q] in a cell, from the cell's eight voxels: `trace_trilinear` says why.
template <class Number>
Bernstein<3> cell_cubic(const Number* corner, const std::array<std::int64_t, 2>& stride, const Double4& p,
                        const Double4& q) {
  const auto [y, z] = stride;
  Double4 low{};
  Double4 high{};
  load2(corner, corner + y, low);
  load2(corner + z, corner + y + z, high);
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

CellMarch::CellMarch(const Grid& grid, Border border, const PiecewiseLinear& transfer, Emission emission, double opaque)
    : size_(grid.size),
      border_(border),
      voxels_(are_binary32(grid) ? Voxels(std::in_place_type<PaddedVoxels<float>>, grid)
                                 : Voxels(std::in_place_type<PaddedVoxels<double>>, grid)),
      intervals_(transfer),
      emission_(emission),
      opaque_(std::min(opaque, 1 - faintest)) {
  const auto [low, high] = grid.range();
  if (const double most = std::max(-low, high); most > largest_voxel)
    throw InputError(fmt::format("voxels up to {}; magnitudes up to 2^500 are allowed", most));
  std::visit([&](const auto& voxels) { find_clear_cells(voxels, ClearScalars(transfer, emission)); }, voxels_);
}

template <class Number>
void CellMarch::find_clear_cells(const PaddedVoxels<Number>& voxels, const ClearScalars& clear) {
  const auto [y, z] = voxels.stride();
  const std::int64_t count = voxels.count() - (1 + y + z);  // all that have a cell, and some in between
  clear_cells_.resize(static_cast<std::size_t>(voxels.count() / 64 + 1));
  // A word, 64 cells, is one thread's.
  tbb::parallel_for(std::size_t{0}, clear_cells_.size(), [&, y = y, z = z](std::size_t word) {
    for (std::int64_t bit = 0; bit < 64; ++bit) {
      const std::int64_t voxel = static_cast<std::int64_t>(word) * 64 + bit;
      if (voxel >= count) break;
      const Number* const corner = voxels.data() + voxel;
      const auto [least, most] = std::minmax(
          {corner[0], corner[1], corner[y], corner[y + 1], corner[z], corner[z + 1], corner[y + z], corner[y + z + 1]});
      if (clear.contain(least, most)) clear_cells_[word] |= std::uint64_t{1} << bit;
    }
  });
}

/// Walks from `begin` to `end`, in voxels along the ray, and keeps the cells that are not clear. All axes go through
/// the same arithmetic in every step, as in CellWalk.
template <class Number>
void CellRay::collect_from(const PaddedVoxels<Number>& voxels, const PixelRay& pixel, double begin, double end) {
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
  const std::array<std::int64_t, 3> stride{1, voxels.stride()[0], voxels.stride()[1]};
  std::int64_t voxel = voxels.at(static_cast<std::int64_t>(cell[0]), static_cast<std::int64_t>(cell[1]),
                                 static_cast<std::int64_t>(cell[2])) -
                       voxels.data();
  std::array<std::int64_t, 3> voxel_step{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    voxel_step[axis] = pixel.ray.direction[axis] > 0 ? stride[axis] : -stride[axis];
  for (double t = begin; t < end;) {
    const Double4 crossing = (exit - offset) * inverse + never;
    const double next = std::min(std::min(crossing[0], crossing[1]), std::min(crossing[2], end));
    const auto crosses = crossing == next + zero;
    if (next > t && !march_.is_clear(voxel)) {
      Double4 here{};
      Double4 there{};
      go_to(t, here);
      go_to(next, there);
      there = crosses ? exit : there;
      cells_.push_back(
          {cell_cubic(voxels.data() + voxel, voxels.stride(), here, there), (next - t) * pixel.length_unit});
    }
    t = std::max(t, next);
    offset -= crosses ? step : zero;
    for (int axis = 0; axis < 3; ++axis) voxel -= crosses[axis] * voxel_step[static_cast<std::size_t>(axis)];
  }
}

RAYTRUTH_DISPATCH
void CellRay::collect(const PixelRay& pixel, double begin, double end) {
  // Not by std::visit: what it calls is not compiled for every level.
  if (const auto* const voxels = std::get_if<PaddedVoxels<float>>(&march_.voxels()))
    collect_from(*voxels, pixel, begin, end);
  else
    collect_from(*std::get_if<PaddedVoxels<double>>(&march_.voxels()), pixel, begin, end);
}

/// Light and opacity of every cell that was collected, or of its parts.
void CellRay::integrate_cells() {
  const auto& knots = march_.intervals().knots();
  lights_.clear();
  std::size_t interval = 0;
  for (const Cell& cell : cells_) {
    const auto& b = cell.cubic.coefficients;
    const double low = std::min(std::min(b[0], b[1]), std::min(b[2], b[3]));
    const double high = std::max(std::max(b[0], b[1]), std::max(b[2], b[3]));
    // Interval k lies between knots k - 1 and k; most cells lie in that of the cell before.
    const auto holds = [&](std::size_t k) {
      return (k == 0 || knots[k - 1] <= low) && (k == knots.size() || high < knots[k]);
    };
    if (!holds(interval))
      interval = static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), low) - knots.begin());
    if (holds(interval)) {
      add_part(cell.cubic, cell.length, interval);
      continue;
    }
    stretches_.clear();
    cut_(march_.intervals(), cell.cubic, 0, stretches_);
    for (const KnotStretch& stretch : stretches_)
      add_part(cell.cubic.restricted(stretch.begin, stretch.end), cell.length * (stretch.end - stretch.begin),
               stretch.interval);
  }
  if (batch_.count > 0) integrate_batch();
}

/// A part of a cell on which the transfer function is one linear function.
void CellRay::add_part(const Bernstein<3>& cubic, double length, std::size_t interval) {
  const LinearInterval& linear = march_.intervals()[interval];
  const double most_depth = length * std::max(linear.at_0.extinction, linear.at_1.extinction);
  const bool is_associated = march_.emission() == Emission::associated;
  if (most_depth == 0 && (is_associated || (linear.most_color == 0))) return;
  if (most_depth > deepest) {
    single_.pieces.assign(1, {0.0, length, cubic});
    single_.end = length;
    const Certified light = integrate_(single_);
    lights_.emplace_back() << light.color, light.opacity;
    return;
  }
  if (most_depth > thick_cell.deepest) {
    const auto [front, back] = cubic.split(0.5);
    add_part(front, length / 2, interval);
    add_part(back, length / 2, interval);
    return;
  }
  const std::size_t lane = batch_.count++;
  for (std::size_t j = 0; j < 4; ++j)
    batch_.cells.x[j][lane] =
        linear.is_linear ? linear.offset + linear.scale * (cubic.coefficients[j] - linear.origin) : 0;
  batch_.cells.extinction_at_0[lane] = linear.at_0.extinction;
  batch_.cells.extinction_at_1[lane] = linear.at_1.extinction;
  batch_.cells.length[lane] = length;
  batch_.index[lane] = lights_.size();
  batch_.interval[lane] = interval;
  batch_.most_depth = std::max(batch_.most_depth, most_depth);
  lights_.emplace_back();
  if (batch_.count == lane_count) integrate_batch();
}

void CellRay::integrate_batch() {
  const CellKernels& kernels = *cell_kernel_versions().front();
  const std::size_t nodes = batch_.most_depth <= thin_cell.deepest ? thin_cell.nodes : thick_cell.nodes;
  const CellLight light = kernels.integrate(batch_.cells, march_.emission() == Emission::associated, nodes);
  for (std::size_t lane = 0; lane < batch_.count; ++lane) {
    const LinearInterval& linear = march_.intervals()[batch_.interval[lane]];
    lights_[batch_.index[lane]] << light.weight_0[lane] * linear.at_0.color + light.weight_1[lane] * linear.at_1.color,
        light.opacity[lane];
  }
  batch_.count = 0;
  batch_.most_depth = 0;
}

/// Puts what was collected behind `sum`, until the ray is opaque.
void CellRay::composite(Eigen::Array4d& sum) {
  integrate_cells();
  Eigen::Array4d light = sum;
  double transmittance = 1 - sum[3];  // by itself, for it is what each part waits for
  for (std::size_t i = 0; i < lights_.size() && light[3] < march_.opaque(); ++i) {
    light += transmittance * lights_[i];
    transmittance *= 1 - lights_[i][3];
  }
  sum = light;
  cells_.clear();
}

Eigen::Array4d CellRay::operator()(const PixelRay& pixel, const std::optional<std::span<const RayPart>>& parts) {
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  const Span inside = clip(march_.size(), march_.border(), pixel.ray.origin, pixel.ray.direction);
  if (!(inside.begin < inside.end)) return sum;
  const auto entry = static_cast<double>(inside.begin);
  const RayPart everything{0, static_cast<double>(inside.end - inside.begin)};
  for (const RayPart& part : parts.value_or(std::span(&everything, 1))) {
    double begin = part.begin;
    while (begin < part.end) {
      const double end = std::min(begin + voxels_at_once, part.end);
      collect(pixel, entry + begin, entry + end);
      begin = end;
      if (cells_.size() < cells_at_once) continue;
      composite(sum);
      if (sum[3] >= march_.opaque()) return sum;
    }
  }
  composite(sum);
  return sum;
}

namespace {

/// Voxels and a transfer function whose scalars count from another origin.
struct Shifted {
  Grid grid;
  PiecewiseLinear transfer;
};

/// The scalars counted from the lowest voxel, where they differ by little of what they are, as labels and times do, so
/// that cubics keep the digits in which they differ. Nothing where that is not so, or where not every difference is
/// exact.
std::optional<Shifted> counted_from_lowest(const Scene& scene) {
  constexpr double little = 0x1p-12;
  const auto [low, high] = scene.grid.range();
  if (!(high - low < little * std::abs(low))) return {};
  bool is_exact = true;
  const auto from_lowest = [&, origin = low](double s) {
    const DoubleDouble difference = two_sum(s, -origin);
    is_exact = is_exact && difference.low == 0;
    return difference.high;
  };
  Grid grid = scene.grid;
  for (double& value : grid.values) value = from_lowest(value);
  std::vector<TransferPoint> points = scene.transfer.points();
  for (TransferPoint& point : points) point.s = from_lowest(point.s);
  if (!is_exact) return {};
  return Shifted{std::move(grid), PiecewiseLinear(std::move(points))};
}

PixelRendererFactory prepare(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto& field = std::get<TrilinearField>(prepared.field);
  const std::optional<Shifted> shifted = counted_from_lowest(scene);
  const PiecewiseLinear& transfer = shifted ? shifted->transfer : scene.transfer;
  const auto march = std::make_shared<const CellMarch>(shifted ? shifted->grid : scene.grid, scene.border, transfer,
                                                       scene.emission, scene.opaque);
  auto blocks = asked_blocks(scene, field);
  if (!blocks)
    blocks = std::make_shared<const OccupiedBlocks>(
        certain_blocks(field, ClearScalars(scene.transfer, scene.emission), prepared.placing_error));
  return [&scene, march, blocks, transfer]() -> PixelRenderer {
    return [march, blocks, ray = CellRay(*march, transfer, scene.emission),
            parts_of = PartsOfRay(scene.grid.size, scene.border, blocks.get())](
               const PixelRay& pixel) mutable -> PixelLight { return {ray(pixel, parts_of(pixel.ray))}; };
  };
}

}  // namespace

extern const Technique cell_march_pixels;
const Technique cell_march_pixels{.name = "cell_march",
                                  .summary = "the cubic of every cell",
                                  .applies =
                                      [](const Scene& scene) {
                                        return scene.scheme == "cell_cubic" && scene.field == FieldKind::trilinear &&
                                               !scene.transfer.is_linear_in_opacity();
                                      },
                                  .refuse = [](const PreparedScene& /*prepared*/) {},
                                  .prepare = prepare};

}  // namespace raytruth
