#include "raytruth/skipping/overshoot.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/signals/ray_ensemble.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace raytruth {

namespace {

using Point = std::array<double, 3>;

constexpr int points_per_interval = 16;
constexpr double smallest_leak = 1e-12;

/// The weights of a run of voxels on one axis.
struct AxisWeights {
  std::int64_t first = 0;
  std::vector<double> weights;
};

/// What every voxel on an axis adds to the tricubic reconstruction at x.
AxisWeights axis_weights(CubicKernel kernel, double x) {
  const double cell = std::floor(x);
  AxisWeights result{static_cast<std::int64_t>(cell) - 1, std::vector<double>(4)};
  for (std::size_t voxel = 0; voxel < 4; ++voxel) {
    Bernstein<3> cubic;
    for (std::size_t i = 0; i < 4; ++i) cubic.coefficients[i] = kernel_coefficient<double>(kernel, i, voxel);
    result.weights[voxel] = cubic.value(x - cell);
  }
  return result;
}

AxisWeights axis_weights(SampleWeights kind, double x) {
  if (kind == SampleWeights::catmull_rom) return axis_weights(CubicKernel::catmull_rom, x);
  AxisWeights spline = axis_weights(CubicKernel::bspline, x);
  if (kind == SampleWeights::bspline) return spline;
  // Voxel v adds sqrt(3) (sqrt(3) - 2)^|k - v| to coefficient k (Unser 1999).
  constexpr std::int64_t reach = 8;
  AxisWeights result{spline.first - reach, std::vector<double>(4 + 2 * reach)};
  for (std::int64_t v = 0; v < 4 + 2 * reach; ++v)
    for (std::int64_t k = 0; k < 4; ++k)
      result.weights[static_cast<std::size_t>(v)] += spline.weights[static_cast<std::size_t>(k)] * std::sqrt(3.0) *
                                                     std::pow(std::sqrt(3.0) - 2, std::abs(k + reach - v));
  return result;
}

Point along(const Point& origin, const Point& direction, double t) {
  Point point;
  for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = origin[axis] + t * direction[axis];
  return point;
}

/// The weights of all voxels in four true samples in a row, and so in the virtual samples between the middle two.
class IntervalWeights {
 public:
  /// The true samples are at front - step direction, front, front + step direction and front + 2 step direction.
  IntervalWeights(SampleWeights kind, const Point& front, const Point& direction, double step) {
    std::array<std::array<AxisWeights, 3>, 4> weights;
    for (std::size_t sample = 0; sample < 4; ++sample) {
      const Point point = along(front, direction, (static_cast<double>(sample) - 1) * step);
      for (std::size_t axis = 0; axis < 3; ++axis) weights[sample][axis] = axis_weights(kind, point[axis]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] =
          std::minmax_element(weights.begin(), weights.end(),
                              [axis](const auto& a, const auto& b) { return a[axis].first < b[axis].first; });
      first[axis] = (*low)[axis].first;
      count[axis] = (*high)[axis].first - first[axis] + static_cast<std::int64_t>((*high)[axis].weights.size());
    }
    for (std::size_t sample = 0; sample < 4; ++sample) fill(true_[sample], weights[sample]);
  }

  [[nodiscard]] const std::vector<double>& of_true_sample(std::size_t sample) const { return true_[sample]; }

  /// The weights at u between the middle two: the rule applied to weights instead of values.
  void at(double u, std::vector<double>& weights) const {
    Rules<double> rules;
    std::array<double, 4> blend{};
    for (std::size_t sample = 0; sample < 4; ++sample) {
      std::array<double, 4> unit{};
      unit[sample] = 1;
      blend[sample] = Rules<double>::cubic(rules.virtual_catmull_rom(unit[0], unit[1], unit[2], unit[3])).value(u);
    }
    weights.resize(true_[0].size());
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = blend[0] * true_[0][i] + blend[1] * true_[1][i] + blend[2] * true_[2][i] + blend[3] * true_[3][i];
  }

  std::array<std::int64_t, 3> first{};  ///< the first voxel of the box that holds all weights
  std::array<std::int64_t, 3> count{};  ///< its size

 private:
  void fill(std::vector<double>& box, const std::array<AxisWeights, 3>& weights) const {
    box.assign(static_cast<std::size_t>(count[0] * count[1] * count[2]), 0.0);
    const auto at_axis = [&](std::size_t axis, std::size_t i) {
      return static_cast<std::int64_t>(i) + weights[axis].first - first[axis];
    };
    for (std::size_t k = 0; k < weights[2].weights.size(); ++k)
      for (std::size_t j = 0; j < weights[1].weights.size(); ++j)
        for (std::size_t i = 0; i < weights[0].weights.size(); ++i)
          box[static_cast<std::size_t>(at_axis(0, i) + count[0] * (at_axis(1, j) + count[1] * at_axis(2, k)))] =
              weights[0].weights[i] * weights[1].weights[j] * weights[2].weights[k];
  }

  std::array<std::vector<double>, 4> true_;
};

/// What a sample with these weights, whose sum is 1, exceeds the data by at most, in units of their range.
double sum_of_negative(const std::vector<double>& weights) {
  double sum = 0;
  for (const double weight : weights) sum += std::max(-weight, 0.0);
  return sum;
}

/// A ray through a random point of a cube of size^3 voxels; every fourth one is parallel to an axis and goes through a
/// multiple of 1/4 voxel on each, where extremes lie.
Ray search_ray(std::int64_t size, std::uint64_t seed, std::uint64_t index) {
  const Grid cube{.size = {size, size, size}, .spacing = {1, 1, 1}, .values = {}};
  Ray ray = random_ray(cube, 0, seed, index);
  if (index % 4 == 0) {
    ray.direction = {};
    ray.direction[index / 4 % 3] = 1;
    for (double& x : ray.origin) x = std::round(4 * x) / 4;
  }
  return ray;
}

/// How far voxel `voxel` is beyond a block of `size` voxels that begins at 0; 0 inside.
std::int64_t distance_beyond(std::int64_t voxel, std::int64_t size) {
  return std::max({-voxel, voxel - (size - 1), std::int64_t{0}});
}

void add_leak(const IntervalWeights& interval, const std::vector<double>& weights, std::int64_t size,
              BlockLeak& found) {
  std::array<double, growths + 1> at_distance{};
  std::size_t index = 0;
  for (std::int64_t k = 0; k < interval.count[2]; ++k)
    for (std::int64_t j = 0; j < interval.count[1]; ++j)
      for (std::int64_t i = 0; i < interval.count[0]; ++i, ++index) {
        const std::int64_t distance =
            std::max({distance_beyond(interval.first[0] + i, size), distance_beyond(interval.first[1] + j, size),
                      distance_beyond(interval.first[2] + k, size)});
        at_distance[std::min(static_cast<std::size_t>(distance), growths)] += std::abs(weights[index]);
      }
  ++found.samples;
  double beyond = at_distance[growths];
  for (std::size_t growth = growths; growth-- > 0;) {
    found.leak[growth] = std::max(found.leak[growth], beyond);
    if (beyond > smallest_leak) ++found.leaking[growth];
    beyond += at_distance[growth];
  }
}

/// The virtual samples of one ray that lie in the block's region.
void search_ray_in_block(BlockRegion region, std::int64_t size, double step, const Ray& ray, double phase,
                         BlockLeak& found) {
  const double margin = region == BlockRegion::cells ? 0 : 0.5;
  const auto is_inside = [&](const Point& point) {
    return std::all_of(point.begin(), point.end(),
                       [&](double x) { return -margin <= x && x <= static_cast<double>(size - 1) + margin; });
  };
  const auto intervals = static_cast<std::int64_t>(std::ceil(std::sqrt(3.0) * static_cast<double>(size) / step)) + 1;
  std::vector<double> weights;
  for (std::int64_t interval = -intervals; interval < intervals; ++interval) {
    const Point front = along(ray.origin, ray.direction, (static_cast<double>(interval) + phase) * step);
    std::vector<double> inside;
    for (int i = 0; i < points_per_interval; ++i) {
      const double u = static_cast<double>(i) / points_per_interval;
      if (is_inside(along(front, ray.direction, u * step))) inside.push_back(u);
    }
    if (inside.empty()) continue;
    const IntervalWeights interval_weights(SampleWeights::bspline, front, ray.direction, step);
    for (const double u : inside) {
      interval_weights.at(u, weights);
      add_leak(interval_weights, weights, size, found);
    }
  }
}

BlockLeak merged(BlockLeak a, const BlockLeak& b) {
  a.samples += b.samples;
  for (std::size_t growth = 0; growth < growths; ++growth) {
    a.leaking[growth] += b.leaking[growth];
    a.leak[growth] = std::max(a.leak[growth], b.leak[growth]);
  }
  return a;
}

/// Sums and maxima of all rays, in any order.
template <class Found, class SearchRay, class Merge>
Found search_rays(std::int64_t rays, SearchRay&& search_one, Merge&& merge) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::int64_t>(0, rays), Found{},
      [&](const auto& range, Found found) {
        for (std::int64_t ray = range.begin(); ray < range.end(); ++ray)
          search_one(static_cast<std::uint64_t>(ray), found);
        return found;
      },
      merge);
}

/// The largest of the cubic's values over all corners of the box that the samples vary in.
template <std::size_t Count, class MakeCubic>
double largest_at_corners(const std::array<std::pair<double, double>, Count>& ranges, MakeCubic&& make_cubic) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t corner = 0; corner < std::size_t{1} << Count; ++corner) {
    std::array<double, Count> samples{};
    for (std::size_t i = 0; i < Count; ++i) samples[i] = (corner >> i & 1U) != 0 ? ranges[i].second : ranges[i].first;
    largest = std::max(largest, Rules<double>::cubic(make_cubic(samples)).range().second);
  }
  return largest;
}

}  // namespace

double largest_virtual_sample(std::pair<double, double> inner, std::pair<double, double> outer) {
  Rules<double> rules;
  return largest_at_corners<4>({outer, inner, inner, outer}, [&rules](const auto& samples) {
    return rules.virtual_catmull_rom(samples[0], samples[1], samples[2], samples[3]);
  });
}

double largest_first_virtual_sample(std::pair<double, double> range) {
  Rules<double> rules;
  return largest_at_corners<3>({range, range, range}, [&rules](const auto& samples) {
    const double ghost = rules.virtual_catmull_rom_ghost(samples[0], samples[1], samples[2]);
    return rules.virtual_catmull_rom(ghost, samples[0], samples[1], samples[2]);
  });
}

Overshoot search_overshoot(SampleWeights weights, double step, std::int64_t rays, std::uint64_t seed) {
  const auto search_one = [&](std::uint64_t index, Overshoot& found) {
    // All that matters is where the samples lie between the voxels: a point in one cell.
    const Ray ray = search_ray(2, seed, index);
    const IntervalWeights interval(weights, ray.origin, ray.direction, step);
    found.of_true_samples = std::max(found.of_true_samples, sum_of_negative(interval.of_true_sample(1)));
    std::vector<double> blended;
    for (int i = 0; i < points_per_interval; ++i) {
      interval.at(static_cast<double>(i) / points_per_interval, blended);
      found.of_virtual_samples = std::max(found.of_virtual_samples, sum_of_negative(blended));
    }
  };
  return search_rays<Overshoot>(rays, search_one, [](const Overshoot& a, const Overshoot& b) {
    return Overshoot{std::max(a.of_true_samples, b.of_true_samples),
                     std::max(a.of_virtual_samples, b.of_virtual_samples)};
  });
}

std::int64_t proven_growth(BlockRegion region, double step) {
  return static_cast<std::int64_t>(std::ceil(2 * step + (region == BlockRegion::cells ? 0 : 0.5))) + 1;
}

BlockLeak search_block(BlockRegion region, std::int64_t size, double step, std::int64_t rays, std::uint64_t seed) {
  const auto search_one = [&](std::uint64_t index, BlockLeak& found) {
    const double phase = random_numbers(seed, RandomStream::points, index)[0];
    search_ray_in_block(region, size, step, search_ray(size, seed, index), phase, found);
  };
  return search_rays<BlockLeak>(rays, search_one, merged);
}

}  // namespace raytruth
