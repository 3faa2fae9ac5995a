#include "raytruth/tables/fast_tables.hpp"

#include "raytruth/kernels/table_kernels.hpp"
#include "raytruth/tables/moments.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>
#include <vector>

namespace raytruth {

namespace {

/// The intervals of a transfer function as kernels read them.
class IntervalArrays {
 public:
  IntervalArrays(const DiscreteTransfer& transfer, double length);

  /// Valid as long as this object.
  [[nodiscard]] TableIntervals view() const;

 private:
  std::array<std::vector<float>, 5> arrays_;  ///< rate, RGB and white
  std::size_t count_;
  float length_;
};

// Plain light is (c / tau) times the opacity, however thin the interval.
constexpr double least_extinction = 1e-20;
constexpr double most_rate = 1e30;  // opaque at every length

IntervalArrays::IntervalArrays(const DiscreteTransfer& transfer, double length)
    : count_(transfer.intervals.size()), length_(static_cast<float>(length)) {
  constexpr std::size_t padding = TableIntervals::padding;
  for (auto& array : arrays_) array.assign(count_ + 2 * padding, 0);
  for (std::size_t k = 0; k < count_; ++k) {
    const auto& [stated, color] = transfer.intervals[k];
    const bool is_plain = transfer.emission == Emission::plain;
    const double extinction = is_plain ? std::max(stated, least_extinction) : stated;
    arrays_[0][padding + k] = static_cast<float>(std::min(extinction * std::numbers::log2e, most_rate));
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const double light = channel < 3 ? color[static_cast<Eigen::Index>(channel)] : 1;
      arrays_[1 + channel][padding + k] = static_cast<float>(is_plain ? light / extinction : light);
    }
  }
}

TableIntervals IntervalArrays::view() const {
  constexpr std::size_t padding = TableIntervals::padding;
  const auto first = [&](std::size_t array) { return arrays_[array].data() + padding; };
  return {.count = count_,
          .rate = first(0),
          .color = {first(1), first(2), first(3), first(4)},
          .most_rate = *std::max_element(arrays_[0].begin(), arrays_[0].end()),
          .length = length_};
}

/// The kernels asked for, or the best ones.
const TableKernels& chosen(const TableKernels* kernels) {
  return kernels != nullptr ? *kernels : *table_kernel_versions().front();
}

void fit(const TableAxes& axes, Table<float>& table) {
  if (table.axes.size != axes.size) table = Table<float>(axes);
  check(axes);
  table.axes = axes;
}

/// Runs a kernel on all bands. `floats` is what it needs for each slab.
void run_bands(const DiscreteTransfer& transfer, const TableAxes& axes, std::size_t band_width, std::size_t floats,
               decltype(TableKernels::subranges) kernel, float* const* tables) {
  const IntervalArrays arrays(transfer, axes.length);
  const TableIntervals intervals = arrays.view();
  tbb::enumerable_thread_specific<std::vector<float>> buffers(floats * band_width * (axes.size + band_width));
  const std::size_t bands = (axes.size + band_width - 2) / band_width;
  tbb::parallel_for(std::size_t{0}, 2 * bands, [&](std::size_t i) {
    kernel(intervals, 1 + i / 2 * band_width, i % 2 == 1, buffers.local().data(), tables);
  });
}

}  // namespace

void build_subrange_table(const DiscreteTransfer& transfer, const TableAxes& axes, Table<float>& table,
                          const TableKernels* kernels) {
  fit(axes, table);
  float* const values = table.values.data();
  run_bands(transfer, axes, chosen(kernels).band_width, TableKernels::slab_floats, chosen(kernels).subranges, &values);
  for (std::size_t i = 0; i < axes.size; ++i) {
    const auto slab = homogeneous_stretch<double>(transfer.entries[i], transfer.emission, axes.length);
    table.set(i, i, slab.cast<float>());
  }
}

void build_moment_tables(const DiscreteTransfer& transfer, const TableAxes& axes, std::array<Table<float>, 4>& tables,
                         const TableKernels* kernels) {
  std::array<float*, 4> values{};
  for (std::size_t k = 0; k < 4; ++k) {
    fit(axes, tables[k]);
    values[k] = tables[k].values.data();
  }
  run_bands(transfer, axes, chosen(kernels).band_width, TableKernels::moment_floats, chosen(kernels).moments,
            values.data());
  for (std::size_t i = 0; i < axes.size; ++i) {
    const auto moments = homogeneous_moments(transfer.entries[i], transfer.emission, axes.length);
    for (std::size_t k = 0; k < 4; ++k) tables[k].set(i, i, moments[k].cast<float>());
  }
}

}  // namespace raytruth
