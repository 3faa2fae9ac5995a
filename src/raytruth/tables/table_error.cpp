#include "raytruth/tables/table_error.hpp"

#include "raytruth/core/chain.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace raytruth {

namespace {

using Vec4 = CertifiedCell::vec4;

constexpr std::size_t few_cells = 8;

/// Slabs of a length whose scalar is linear, certified; one object per thread.
class LinearSlab {
 public:
  LinearSlab(const PiecewiseLinear& transfer, double length, Emission emission)
      : integrate_(transfer, emission),
        slab_{.pieces = {{.start = 0.0, .length = length, .polynomial = {}}}, .end = length} {}

  Vec4 operator()(double front, double back) {
    slab_.pieces.front().polynomial = Bernstein<1>{{front, back}}.elevated<3>();
    const Certified slab = integrate_(slab_);
    radius_ = std::max(radius_, slab.radius);
    return {slab.color[0], slab.color[1], slab.color[2], slab.opacity};
  }

  [[nodiscard]] double radius() const { return radius_; }

 private:
  RayIntegral integrate_;
  Chain<3> slab_;
  double radius_ = 0;
};

/// Consecutive cells along an axis, of which one is looked at.
struct Block {
  std::size_t begin;
  std::size_t end;

  [[nodiscard]] std::size_t length() const { return end - begin; }
  [[nodiscard]] std::size_t drawn(double uniform) const {
    return begin + static_cast<std::size_t>(uniform * static_cast<double>(length()));
  }
};

/// Cells along an axis that hold points of the transfer function, ascending.
std::vector<std::size_t> cells_with_points(const TableAxes& axes, const PiecewiseLinear& transfer) {
  std::vector<std::size_t> cells;
  for (const TransferPoint& point : transfer.points()) {
    const double share = (point.s - axes.low) / (axes.high - axes.low);
    if (!(0 <= share && share < 1)) continue;
    const auto cell = static_cast<std::size_t>(share * static_cast<double>(axes.size - 1));
    if (cells.empty() || cells.back() != cell) cells.push_back(cell);
  }
  return cells;
}

/// `most` equal blocks of `count` cells, cut so that each of the `single` ones is a block of its own.
std::vector<Block> blocks_of(std::size_t count, std::size_t most, const std::vector<std::size_t>& single) {
  std::vector<std::size_t> borders{count};
  for (std::size_t i = 0; i < std::min(count, most); ++i) borders.push_back(i * count / std::min(count, most));
  for (const std::size_t cell : single) borders.insert(borders.end(), {cell, cell + 1});
  std::sort(borders.begin(), borders.end());
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  std::vector<Block> blocks;
  for (std::size_t i = 1; i < borders.size(); ++i) blocks.push_back({borders[i - 1], borders[i]});
  return blocks;
}

std::vector<CertifiedCell> chosen_cells(const TableAxes& axes, const PiecewiseLinear& transfer, std::size_t most,
                                        std::uint64_t seed) {
  std::vector<CertifiedCell> cells;
  const auto add = [&cells](std::size_t front, std::size_t back) -> CertifiedCell& {
    CertifiedCell& cell = cells.emplace_back();
    cell.front = front;
    cell.back = back;
    return cell;
  };
  const std::size_t count = axes.size - 1;
  const bool is_whole = count <= most;
  std::vector<std::size_t> with_points = cells_with_points(axes, transfer);
  const bool are_few = with_points.size() <= few_cells;
  const std::vector<Block> blocks = blocks_of(count, most, are_few ? with_points : std::vector<std::size_t>{});
  for (std::size_t j = 0; j < blocks.size(); ++j)
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const auto random = random_numbers(seed, RandomStream::points, j * blocks.size() + i);
      CertifiedCell& cell = add(blocks[i].drawn(random[0]), blocks[j].drawn(random[1]));
      cell.weight = static_cast<double>(blocks[i].length() * blocks[j].length());
      if (is_whole && cell.is_in_band()) cell.band_weight = 1;
    }
  if (is_whole) return cells;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::size_t front = blocks[i].drawn(random_numbers(seed, RandomStream::points, i, 1)[0]);
    for (std::size_t back = front > 0 ? front - 1 : 0; back <= std::min(front + 1, count - 1); ++back)
      add(front, back).band_weight = static_cast<double>(blocks[i].length());
  }
  if (!are_few)
    for (std::size_t i = 0; i < std::min(most, with_points.size()); ++i) {
      const std::size_t cell = with_points[i * with_points.size() / std::min(most, with_points.size())];
      add(cell, cell);
    }
  return cells;
}

}  // namespace

std::array<double, 2> place_of(const TableAxes& axes, const CertifiedCell& cell, std::size_t place) {
  const double width = (axes.high - axes.low) / static_cast<double>(axes.size - 1);
  const auto scalar = [&](std::size_t entry, std::size_t k) {
    return axes.low + width * (static_cast<double>(entry) + places_of_axis[k]);
  };
  return {scalar(cell.front, place % places_per_axis), scalar(cell.back, place / places_per_axis)};
}

CertifiedCells certified_cells(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                               std::size_t most, std::uint64_t seed) {
  check(axes);
  CertifiedCells result{.axes = axes, .cells = chosen_cells(axes, transfer, most, seed)};
  tbb::enumerable_thread_specific<LinearSlab> slabs(transfer, axes.length, emission);
  tbb::parallel_for(std::size_t{0}, result.cells.size(), [&](std::size_t i) {
    CertifiedCell& cell = result.cells[i];
    LinearSlab& slab = slabs.local();
    for (std::size_t place = 0; place < cell.slabs.size(); ++place) {
      const auto [front, back] = place_of(axes, cell, place);
      cell.slabs[place] = slab(front, back);
    }
    for (std::size_t corner = 0; corner < cell.entries.size(); ++corner)
      cell.entries[corner] = slab(axes.scalar(cell.front + corner % 2), axes.scalar(cell.back + corner / 2));
  });
  for (const LinearSlab& slab : slabs) result.radius = std::max(result.radius, slab.radius());
  return result;
}

}  // namespace raytruth
