#include "raytruth/tables/fast_second_order.hpp"

#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace raytruth {

namespace {

/// A transfer function at a table's entries as kernels read it, rates extinction times `length`; `is_mirrored`: from
/// the last entry down.
class EntryArrays {
 public:
  EntryArrays(const PiecewiseLinear& transfer, const TableAxes& axes, double length, bool is_mirrored)
      : count_(axes.size) {
    constexpr std::size_t padding = 16;
    for (auto* const lists : {&values_, &differences_})
      for (auto& list : *lists) list.resize(count_ + padding);
    for (std::size_t i = 0; i < count_; ++i) {
      const Optics optics = transfer.at(axes.scalar(is_mirrored ? count_ - 1 - i : i));
      for (std::size_t c = 0; c < 3; ++c)
        values_[c][i] = static_cast<float>(optics.color[static_cast<Eigen::Index>(c)]);
      values_[3][i] = static_cast<float>(optics.extinction * length);
    }
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i + 1 < count_; ++i) differences_[c][i] = values_[c][i + 1] - values_[c][i];
  }

  /// Valid as long as this object.
  [[nodiscard]] TransferEntries view() const {
    return {.count = count_,
            .rate = values_[3].data(),
            .rate_difference = differences_[3].data(),
            .color = {values_[0].data(), values_[1].data(), values_[2].data()},
            .color_difference = {differences_[0].data(), differences_[1].data(), differences_[2].data()},
            .most_rate = *std::max_element(values_[3].begin(), values_[3].end())};
  }

 private:
  std::size_t count_;
  std::array<std::vector<float>, 4> values_;       ///< three channels and the rate
  std::array<std::vector<float>, 4> differences_;  ///< of the next entry from this one
};

/// Exact slabs whose ends lie in two blocks of entries, as many as kernels have lanes, `lower` and `upper`, or both in
/// one. A kernel gives a slab and its reverse, one of which lies in another row of the table for every lane: so they
/// are gathered here before they are copied. Holds buffers: one object per thread.
class ExactTile {
 public:
  ExactTile(Table3<float>& table, const PiecewiseLinear& transfer, const SlabKernels& kernels)
      : table_(&table),
        kernels_(&kernels),
        lanes_(kernels.parabola_lanes),
        entries_(transfer, table.axes, 2 * table.axes.length, false),
        mirrored_(transfer, table.axes, 2 * table.axes.length, true),
        certified_(transfer, table.axes, Emission::associated),
        rising_(4 * lanes_),
        falling_(4 * lanes_),
        texels_(std::size_t{2} * 4 * lanes_ * lanes_) {}

  void operator()(std::size_t lower, std::size_t middle, std::size_t upper) {
    lower_ = lower;
    middle_ = middle;
    upper_ = upper;
    const std::size_t last = table_->axes.size - 1;
    const std::size_t last_lower = std::min(lower + lanes_ - 1, last);
    const std::size_t last_upper = std::min(upper + lanes_ - 1, last);
    // Parabolas that are open downwards, lower ends in lanes; and those that are open upwards, upside down.
    for (std::size_t end = upper; end <= last_upper && lower + end <= 2 * middle; ++end) {
      const std::uint32_t too_deep = kernels_->parabolas(
          entries_.view(),
          {.lower = index_of(lower), .direction = 1, .middle = index_of(middle), .upper = index_of(end)},
          rising_.data(), falling_.data());
      for (std::size_t lane = 0; lower + lane <= std::min(last_lower, end) && lower + lane + end <= 2 * middle; ++lane)
        put(lower + lane, end, rising_.data() + 4 * lane, falling_.data() + 4 * lane, (too_deep >> lane) % 2 != 0);
    }
    for (std::size_t end = lower; end <= last_lower; ++end) {
      if (end + last_upper <= 2 * middle) continue;
      const std::uint32_t too_deep = kernels_->parabolas(mirrored_.view(),
                                                         {.lower = index_of(last) - index_of(upper),
                                                          .direction = -1,
                                                          .middle = index_of(last - middle),
                                                          .upper = index_of(last - end)},
                                                         rising_.data(), falling_.data());
      for (std::size_t lane = 0; upper + lane <= last_upper; ++lane)
        if (upper + lane >= end && end + upper + lane > 2 * middle)
          put(end, upper + lane, falling_.data() + 4 * lane, rising_.data() + 4 * lane, (too_deep >> lane) % 2 != 0);
    }
    copy(texels_.data(), lower, last_lower, upper, last_upper);
    copy(reverse(), upper, last_upper, lower, last_lower);
  }

 private:
  static std::ptrdiff_t index_of(std::size_t entry) { return static_cast<std::ptrdiff_t>(entry); }

  /// The tile with the upper ends in front; one that lies on the table's diagonal has both.
  float* reverse() { return texels_.data() + (lower_ == upper_ ? 0 : 4 * lanes_ * lanes_); }

  void put(std::size_t lower, std::size_t upper, const float* rising, const float* falling, bool is_too_deep) {
    const TableAxes& axes = table_->axes;
    const auto put_one = [&](float* tile, std::size_t column, std::size_t row, std::size_t front, std::size_t back,
                             const float* texel) {
      float* const to = tile + 4 * (row * lanes_ + column);
      if (!is_too_deep) {
        std::copy_n(texel, 4, to);
        return;
      }
      const Certified slab = certified_.certified({axes.scalar(front), axes.scalar(middle_), axes.scalar(back)});
      for (std::size_t c = 0; c < 3; ++c) to[c] = static_cast<float>(slab.color[static_cast<Eigen::Index>(c)]);
      to[3] = static_cast<float>(slab.opacity);
    };
    put_one(texels_.data(), lower - lower_, upper - upper_, lower, upper, rising);
    put_one(reverse(), upper - upper_, lower - lower_, upper, lower, falling);
  }

  void copy(const float* tile, std::size_t front, std::size_t last_front, std::size_t back, std::size_t last_back) {
    for (std::size_t row = back; row <= last_back; ++row)
      std::copy_n(tile + 4 * (row - back) * lanes_, 4 * (last_front - front + 1), table_->texel(front, middle_, row));
  }

  Table3<float>* table_;
  const SlabKernels* kernels_;
  std::size_t lanes_;
  EntryArrays entries_;
  EntryArrays mirrored_;
  SecondOrderSlabs certified_;
  std::vector<float> rising_;
  std::vector<float> falling_;
  std::vector<float> texels_;
  std::size_t lower_ = 0;
  std::size_t middle_ = 0;
  std::size_t upper_ = 0;
};

}  // namespace

bool is_linear_between_entries(const PiecewiseLinear& transfer, const TableAxes& axes) {
  if (transfer.is_linear_in_opacity()) return false;
  const auto& points = transfer.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double place = (points[i].s - axes.low) / (axes.high - axes.low) * static_cast<double>(axes.size - 1);
    if (std::abs(place - std::round(place)) > 1e-9) return false;
    if (i > 0 && points[i - 1].s == points[i].s) return false;
  }
  return true;
}

void fill_second_order_table(Table3<float>& table, const PiecewiseLinear& transfer, const Iterations& iterations,
                             const SlabKernels& kernels) {
  const TableAxes& axes = table.axes;
  constexpr float most_rate = 0.5F;
  const std::size_t n = axes.size;
  const EntryArrays arrays(transfer, axes, axes.length / iterations.count * std::numbers::log2e, false);
  const TransferEntries entries = arrays.view();
  std::array<std::vector<float>, 3> weights;
  for (int k = 0; k < iterations.count; ++k) {
    const double t = (k + (iterations.is_left ? 0 : 0.5)) / iterations.count;
    weights[0].push_back(static_cast<float>((1 - t) * (1 - 2 * t)));
    weights[1].push_back(static_cast<float>(4 * t * (1 - t)));
    weights[2].push_back(static_cast<float>(t * (2 * t - 1)));
  }
  const SecondOrderSteps steps{.count = weights[0].size(),
                               .front_weight = weights[0].data(),
                               .middle_weight = weights[1].data(),
                               .back_weight = weights[2].data(),
                               .is_thin = entries.most_rate <= most_rate};
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t back) {
    for (std::size_t middle = 0; middle < n; ++middle)
      kernels.second_order_row(entries, steps, middle, back, table.texel(0, middle, back));
  });
}

void fill_exact_second_order_table(Table3<float>& table, const PiecewiseLinear& transfer, const SlabKernels& kernels) {
  const std::size_t n = table.axes.size;
  tbb::enumerable_thread_specific<ExactTile> tiles([&] { return ExactTile(table, transfer, kernels); });
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t middle) {
    ExactTile& tile = tiles.local();
    for (std::size_t upper = 0; upper < n; upper += kernels.parabola_lanes)
      for (std::size_t lower = 0; lower <= upper; lower += kernels.parabola_lanes) tile(lower, middle, upper);
  });
}

}  // namespace raytruth
