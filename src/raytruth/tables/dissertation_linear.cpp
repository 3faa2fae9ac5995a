#include "raytruth/tables/dissertation_linear.hpp"

#include "raytruth/schemes/slab_integrals.hpp"
#include "raytruth/tables/discrete_transfer.hpp"
#include "raytruth/tables/interval_slabs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

/// The exponents j of the distances 2^j that reach from a slab's length over n - 1 to the length.
struct Distances {
  int first;
  int last;
};

Distances distances_of(double length, std::size_t size) {
  return {static_cast<int>(std::floor(std::log2(length / static_cast<double>(size - 1)))),
          static_cast<int>(std::ceil(std::log2(length)))};
}

/// The share that d_j has in the interpolation at a distance.
double share_of(int j, double distance) {
  const double d = std::exp2(j);
  if (distance <= d) return std::max(0.0, 1 - (d - distance) / (d / 2));
  return std::max(0.0, 1 - (distance - d) / d);
}

/// Adds up shares of slabs, their opacities as such or by the logarithm of what passes.
class Interpolation {
 public:
  explicit Interpolation(DistanceInterpolation what) : what_(what) {}

  void add(Eigen::Map<Vec4> sum, double share, const Vec4& slab, double depth) const {
    if (share == 0) return;
    sum.head<3>() += share * slab.head<3>();
    sum[3] += share * (what_ == DistanceInterpolation::logarithm ? depth : slab[3]);
  }

  void finish(Eigen::Map<Vec4> sum) const {
    if (what_ == DistanceInterpolation::logarithm) sum[3] = -std::expm1(-sum[3]);
  }

 private:
  DistanceInterpolation what_;
};

/// The optics that a table needs, for one direction of crossing: entry i and interval i in that order.
struct Crossing {
  std::vector<Vec4> optics;             ///< q and tau at the entries
  std::vector<double> interval_depths;  ///< means of tau
  std::vector<double> depths;           ///< sums of these up to the entry, A(s) in units of an interval
};

Crossing cross(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission, bool backwards) {
  Crossing result;
  const OpticsLookup<double> look_up(transfer, emission);
  for (std::size_t i = 0; i < axes.size; ++i) result.optics.push_back(look_up(axes.scalar(i)));
  for (const Optics& mean : interval_means(transfer, axes, emission).intervals)
    result.interval_depths.push_back(mean.extinction);
  if (backwards) {
    std::reverse(result.optics.begin(), result.optics.end());
    std::reverse(result.interval_depths.begin(), result.interval_depths.end());
  }
  result.depths.push_back(0);
  for (const double depth : result.interval_depths) result.depths.push_back(result.depths.back() + depth);
  return result;
}

/// Recurrence (5.2.22), or algorithm 2 of it.
void as_printed(const Crossing& crossing, bool backwards, DissertationAlgorithm algorithm,
                const Interpolation& interpolation, Table<double>& table) {
  const std::size_t size = table.axes.size;
  const double length = table.axes.length;
  const auto [first, last] = distances_of(length, size);
  const std::size_t count = static_cast<std::size_t>(last - first) + 1;
  const auto distance = [first = first](std::size_t j) { return std::exp2(first + static_cast<int>(j)); };

  // color1d[j][i], of the interval that ends at entry i
  std::vector<std::vector<Vector3<double>>> color_1d(count);
  for (std::size_t j = 0; j < count; ++j) {
    const auto from_0 = [&](std::size_t i) {  // 1 - opacity[j][0][i]
      return i == 0 ? 1.0 : std::exp(-distance(j) * crossing.depths[i] / static_cast<double>(i));
    };
    color_1d[j].assign(size, Vector3<double>::Constant(0));
    for (std::size_t i = 1; i < size; ++i)
      color_1d[j][i] = distance(j) * 0.5 *
                       (from_0(i - 1) * crossing.optics[i - 1].head<3>() + from_0(i) * crossing.optics[i].head<3>());
  }

  for (std::size_t front = 0; front < size; ++front) {
    // Temp of the text, without its offset: C_j at the entry before
    std::vector<Vector3<double>> before(count);
    for (std::size_t j = 0; j < count; ++j)
      before[j] = Rules<double>{}.homogeneous_slab(crossing.optics[front], distance(j), false).head<3>();
    for (std::size_t back = front + 1; back < size; ++back) {
      const std::size_t to_front = backwards ? size - 1 - front : front;
      const std::size_t to_back = backwards ? size - 1 - back : back;
      for (std::size_t j = count; j-- > 0;) {  // from the last, so that C_(j-1) is still the one before
        const Vector3<double> composited = algorithm == DissertationAlgorithm::pseudo_code ? before[j]
                                           : j > 0                                         ? before[j - 1]
                                                   : Vector3<double>::Constant(0);
        before[j] = composited * std::exp(-distance(j) * crossing.interval_depths[back - 1]) + color_1d[j][back];
        const double depth =
            distance(j) * (crossing.depths[back] - crossing.depths[front]) / static_cast<double>(back - front);
        Vec4 slab;
        slab << before[j], -std::expm1(-depth);
        interpolation.add(Eigen::Map<Vec4>(table.texel(to_front, to_back)),
                          share_of(first + static_cast<int>(j), length), slab, depth);
      }
    }
  }
}

/// The corrected algorithm: front to back, d fixed.
void corrected(const IntervalSlabs& interval_slabs, const Crossing& crossing, bool backwards,
               const Interpolation& interpolation, Table<double>& table) {
  const std::size_t size = table.axes.size;
  const auto [first, last] = distances_of(table.axes.length, size);
  for (int j = first; j <= last; ++j) {
    const double d = std::exp2(j);
    const std::vector<Vec4> slabs = interval_slabs(d, backwards);
    for (std::size_t front = 0; front < size; ++front) {
      Vec4 slab = Vec4::Constant(0);
      for (std::size_t back = front + 1; back < size; ++back) {
        slab = Rules<double>{}.over(slab, slabs[back - 1]);
        interpolation.add(
            Eigen::Map<Vec4>(table.texel(backwards ? size - 1 - front : front, backwards ? size - 1 - back : back)),
            share_of(j, table.axes.length / static_cast<double>(back - front)), slab,
            d * (crossing.depths[back] - crossing.depths[front]));
      }
    }
  }
}

}  // namespace

Table<double> dissertation_linear_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                                        DissertationAlgorithm algorithm, DistanceInterpolation interpolation) {
  Table<double> table(axes);
  const IntervalSlabs interval_slabs(transfer, axes, emission);
  const Interpolation shares(interpolation);
  for (const bool backwards : {false, true}) {
    const Crossing crossing = cross(transfer, axes, emission, backwards);
    if (algorithm == DissertationAlgorithm::corrected)
      corrected(interval_slabs, crossing, backwards, shares, table);
    else
      as_printed(crossing, backwards, algorithm, shares, table);
  }
  for (std::size_t back = 0; back < axes.size; ++back)
    for (std::size_t front = 0; front < axes.size; ++front)
      if (front == back)
        table.set(front, front, homogeneous_stretch<double>(transfer.at(axes.scalar(front)), emission, axes.length));
      else
        shares.finish(Eigen::Map<Vec4>(table.texel(front, back)));
  return table;
}

TableCost dissertation_linear_cost(std::int64_t size) {
  const auto [first, last] = distances_of(1, static_cast<std::size_t>(size));
  const std::int64_t distances = last - first + 1;
  return {.composites = distances * size * (size - 1), .exponentials = distances * size * (size - 1) + size};
}

}  // namespace raytruth
