#include "raytruth/tables/fast_quadratic_gray.hpp"

#include "raytruth/kernels/gauss_legendre.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/schemes/quadratic_gray.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>

namespace raytruth {

namespace {

/// A transfer function at a table's entries, constant beyond both ends as far as slabs lead; rates are extinction times
/// the slabs' length.
class PaddedEntries {
 public:
  PaddedEntries(const PiecewiseLinear& transfer, const TableAxes& axes) : count_(axes.size) {
    constexpr std::size_t behind = 16;  // what kernels read besides
    const std::size_t size = 3 * count_ + behind;
    for (std::size_t c = 0; c < 4; ++c) {
      values_[c].resize(size);
      differences_[c].resize(size);
    }
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t entry = std::clamp(i, count_, 2 * count_ - 1) - count_;
      const Optics optics = transfer.at(axes.scalar(entry));
      for (std::size_t c = 0; c < 3; ++c)
        values_[c][i] = static_cast<float>(optics.color[static_cast<Eigen::Index>(c)]);
      values_[3][i] = static_cast<float>(optics.extinction * axes.length);
    }
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i + 1 < size; ++i) differences_[c][i] = values_[c][i + 1] - values_[c][i];
  }

  /// Entries from -n to 2 n - 1 are readable. Valid as long as this object.
  [[nodiscard]] TransferEntries view() const {
    const auto at = [this](const std::vector<float>& list) { return list.data() + count_; };
    return {.count = count_,
            .rate = at(values_[3]),
            .rate_difference = at(differences_[3]),
            .color = {at(values_[0]), at(values_[1]), at(values_[2])},
            .color_difference = {at(differences_[0]), at(differences_[1]), at(differences_[2])},
            .most_rate = *std::max_element(values_[3].begin(), values_[3].end())};
  }

 private:
  std::size_t count_;
  std::array<std::vector<float>, 4> values_;  ///< three channels and the rate
  std::array<std::vector<float>, 4> differences_;
};

/// The places where all slabs of a diagonal meet entries. Scalars are counted in entries from the front, the way is 1
/// long. Holds buffers: one object per thread.
class DiagonalCuts {
 public:
  explicit DiagonalCuts(std::size_t size) {
    const auto n = static_cast<std::ptrdiff_t>(size);
    for (std::ptrdiff_t k = 1 - n; k < n; ++k) scalars_.push_back(static_cast<double>(k));
  }

  /// A part of the way between two neighbouring entries: place x = x0 + x1 u + x2 u^2 in their interval, 0 at the lower
  /// one, for u = 0 to 1.
  struct Part {
    std::ptrdiff_t entry = 0;
    double width = 0;
    std::array<double, 3> place{};
  };

  /// The parts, front to back, of slabs that rise by `rise` entries, `curvature` in entries per squared length.
  const std::vector<Part>& operator()(std::ptrdiff_t rise, double curvature) {
    const QuadraticGray slab = QuadraticGray::of_curvature(0, static_cast<double>(rise), curvature, 1);
    cut(slab, scalars_, cuts_);
    parts_.clear();
    const auto n = static_cast<std::ptrdiff_t>(scalars_.size() + 1) / 2;
    const double slope = static_cast<double>(rise) - curvature;
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
      const double from = cuts_[i].z / slab.scaled_length;
      const double to = cuts_[i + 1].z / slab.scaled_length;
      if (!(to > from)) continue;
      // Before the first scalar, and behind the last one, every slab is beyond the table's ends.
      const std::ptrdiff_t entry = static_cast<std::ptrdiff_t>(cuts_[i].interval) - n;
      const double width = to - from;
      parts_.push_back({.entry = entry,
                        .width = width,
                        .place = {from * (slope + curvature * from) - static_cast<double>(entry),
                                  width * (slope + 2 * curvature * from), curvature * width * width}});
    }
    return parts_;
  }

 private:
  std::vector<double> scalars_;
  std::vector<QuadraticGrayCut> cuts_;
  std::vector<Part> parts_;
};

double mean_place(const std::array<double, 3>& place, double u) {
  return place[0] + u * (place[1] / 2 + u * place[2] / 3);
}

/// The mean of x^2 over u = 0 to 1.
double mean_square_place(const std::array<double, 3>& place) {
  const auto& [x0, x1, x2] = place;
  return x0 * x0 + x0 * x1 + (x1 * x1 + 2 * x0 * x2) / 3 + x1 * x2 / 2 + x2 * x2 / 5;
}

/// What a kernel does on a diagonal.
class DiagonalPlan {
 public:
  explicit DiagonalPlan(std::size_t size) : cuts_(size) {}

  DiagonalSlabs operator()(std::ptrdiff_t rise, double curvature, float most_rate, double plain_length) {
    stretches_.clear();
    nodes_.clear();
    for (const DiagonalCuts::Part& part : cuts_(rise, curvature)) {
      const double steepest = part.width * static_cast<double>(most_rate);
      const double count = std::ceil(std::clamp(steepest / deepest, 1.0, most_parts));
      for (std::int64_t i = 0; i < static_cast<std::int64_t>(count); ++i)
        add(part, static_cast<double>(i) / count, 1 / count, steepest / count, plain_length);
    }
    return {.stretches = stretches_.data(),
            .stretch_count = stretches_.size(),
            .nodes = nodes_.data(),
            .is_plain = plain_length > 0};
  }

 private:
  // Depths up to which rules of so many nodes err by less than 4e-7 and 10^-6.
  static constexpr double deepest_of_4_nodes = 0.5;
  // Moments will do up to this depth, and up to this depth^2 |bend|.
  static constexpr double deepest_of_moments = 0.1;
  static constexpr double deepest_of_faint_moments = 0.02;
  static constexpr double most_bend_of_moments = 1e-4;
  static constexpr double deepest = 3;
  static constexpr double most_parts = 1e6;  // such a part is opaque
  static constexpr std::size_t nodes_of_deep_parts = 6;

  void add(const DiagonalCuts::Part& part, double start, double share, double steepest, double plain_length) {
    const auto& [x0, x1, x2] = part.place;
    const std::array place{x0 + start * (x1 + start * x2), share * (x1 + 2 * x2 * start), x2 * share * share};
    const double width = part.width * share;
    const double end = place[0] + place[1] + place[2];
    const bool is_whole = std::abs(place[0] + end - 1) < 1e-9 && std::abs(std::abs(end - place[0]) - 1) < 1e-9;
    const bool by_moments = plain_length == 0 && is_whole && steepest <= deepest_of_moments &&
                            steepest * steepest * std::abs(place[2]) <= most_bend_of_moments;
    const NodeTable<3>& rule = node_table<3>(steepest <= deepest_of_4_nodes ? 4 : nodes_of_deep_parts);
    stretches_.push_back({.entry = part.entry,
                          .depth_rate = static_cast<float>(width),
                          .depth_difference = static_cast<float>(width * mean_place(place, 1)),
                          .first_node = nodes_.size(),
                          .node_count = by_moments ? 0 : rule.count,
                          .is_thin = steepest * std::numbers::log2e <= 0.5,
                          .by_moments = by_moments,
                          .is_faint = by_moments && steepest <= deepest_of_faint_moments,
                          .falls = place[0] > end,
                          .moment_difference = static_cast<float>(width * mean_square_place(place))});
    if (by_moments) return;
    for (std::size_t k = 0; k < rule.count; ++k) {
      const double u = rule.nodes[k];
      nodes_.push_back({.weight = static_cast<float>(width * rule.weights[k] * (plain_length > 0 ? plain_length : 1)),
                        .place = static_cast<float>(place[0] + u * (place[1] + u * place[2])),
                        .depth_rate = static_cast<float>(width * u),
                        .depth_difference = static_cast<float>(width * u * mean_place(place, u))});
    }
  }

  DiagonalCuts cuts_;
  std::vector<DiagonalStretch> stretches_;
  std::vector<DiagonalNode> nodes_;
};

/// The diagonals of a table: |rise| < n, and the front entries of their slabs.
struct Diagonal {
  std::ptrdiff_t rise = 0;
  std::size_t first_front = 0;
  std::size_t count = 0;

  Diagonal(std::size_t size, std::size_t i)
      : rise(static_cast<std::ptrdiff_t>(i) - static_cast<std::ptrdiff_t>(size) + 1),
        first_front(rise < 0 ? static_cast<std::size_t>(-rise) : 0),
        count(size - static_cast<std::size_t>(std::abs(rise))) {}

  [[nodiscard]] std::size_t first_back() const {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(first_front) + rise);
  }
};

/// Entries per squared length, where a slab is 1 long.
double in_entries(double curvature, const TableAxes& axes) {
  return curvature * axes.length * axes.length * static_cast<double>(axes.size - 1) / (axes.high - axes.low);
}

}  // namespace

void fill_quadratic_gray_table(QuadraticGrayTable<float>& table, const PiecewiseLinear& transfer, Emission emission,
                               const SlabKernels& kernels) {
  const std::size_t n = table.axes.size;
  const PaddedEntries padded(transfer, table.axes);
  const TransferEntries entries = padded.view();
  tbb::enumerable_thread_specific<DiagonalPlan> plans([n] { return DiagonalPlan(n); });
  tbb::parallel_for(std::size_t{0}, table.radius.node_count() * (2 * n - 1), [&](std::size_t i) {
    const std::size_t node = i / (2 * n - 1);
    const Diagonal diagonal(n, i % (2 * n - 1));
    DiagonalSlabs slabs = plans.local()(diagonal.rise, in_entries(table.curvature(node), table.axes), entries.most_rate,
                                        emission == Emission::plain ? table.axes.length : 0);
    slabs.first = diagonal.first_front;
    slabs.count = diagonal.count;
    slabs.stride = 4 * (n + 1);
    kernels.diagonal(entries, slabs, table.texel(node, diagonal.first_front, diagonal.first_back()));
  });
}

std::vector<float> quadratic_gray_opacities(const TableAxes& axes, const RadiusAxis& radius,
                                            const PiecewiseLinear& transfer, const SlabKernels& kernels) {
  const QuadraticGrayTable<float> shape(axes, {.low = 1, .high = 1, .count = 1});  // checks the axes
  check(radius);
  const std::size_t n = axes.size;
  const PaddedEntries padded(transfer, axes);
  const TransferEntries entries = padded.view();
  std::vector<float> opacities(radius.node_count() * n * n);
  struct Buffers {
    DiagonalCuts cuts;
    std::vector<float> weights = {};
    std::vector<float> diagonal = {};
  };
  tbb::enumerable_thread_specific<Buffers> buffers([n] { return Buffers{.cuts = DiagonalCuts(n)}; });
  // Opacity is symmetric in its ends: only slabs that rise are computed.
  tbb::parallel_for(std::size_t{0}, radius.node_count() * n, [&](std::size_t i) {
    const std::size_t node = i / n;
    const Diagonal diagonal(n, n - 1 + i % n);
    Buffers& own = buffers.local();
    const auto& parts = own.cuts(diagonal.rise, in_entries(radius.curvature(node) * shape.gray, axes));
    std::ptrdiff_t lowest = parts.front().entry;
    std::ptrdiff_t highest = parts.front().entry;
    for (const DiagonalCuts::Part& part : parts) {
      lowest = std::min(lowest, part.entry);
      highest = std::max(highest, part.entry);
    }
    own.weights.assign(static_cast<std::size_t>(highest - lowest) + 2, 0.0F);
    for (const DiagonalCuts::Part& part : parts) {
      const auto at = static_cast<std::size_t>(part.entry - lowest);
      const auto upper = static_cast<float>(part.width * mean_place(part.place, 1));
      const auto last = static_cast<std::ptrdiff_t>(n) - 1;
      const bool is_beyond = part.entry >= last || part.entry < -last;  // where all rates are the same
      own.weights[at] += static_cast<float>(part.width) - (is_beyond ? 0.0F : upper);
      own.weights[at + 1] += is_beyond ? 0.0F : upper;
    }
    own.diagonal.resize(n);
    kernels.diagonal_opacities(entries.rate + static_cast<std::ptrdiff_t>(diagonal.first_front) + lowest,
                               own.weights.data(), own.weights.size(), diagonal.count, own.diagonal.data());
    float* const table = opacities.data() + node * n * n;
    for (std::size_t k = 0; k < diagonal.count; ++k) {
      const std::size_t front = diagonal.first_front + k;
      const std::size_t back = diagonal.first_back() + k;
      table[back * n + front] = table[front * n + back] = own.diagonal[k];
    }
  });
  return opacities;
}

}  // namespace raytruth
