#include "raytruth/tables/fast_tables.hpp"

#include "raytruth/tables/interval_arrays.hpp"
#include "raytruth/tables/moments.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <vector>

namespace raytruth {

namespace {

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
                          const TableKernels& kernels) {
  fit(axes, table);
  float* const values = table.values.data();
  run_bands(transfer, axes, kernels.band_width, TableKernels::slab_floats, kernels.subranges, &values);
  for (std::size_t i = 0; i < axes.size; ++i) {
    const auto slab = homogeneous_stretch<double>(transfer.entries[i], transfer.emission, axes.length);
    table.set(i, i, slab.cast<float>());
  }
}

void build_moment_tables(const DiscreteTransfer& transfer, const TableAxes& axes, std::array<Table<float>, 4>& tables,
                         const TableKernels& kernels) {
  std::array<float*, 4> values{};
  for (std::size_t k = 0; k < 4; ++k) {
    fit(axes, tables[k]);
    values[k] = tables[k].values.data();
  }
  run_bands(transfer, axes, kernels.band_width, TableKernels::moment_floats, kernels.moments, values.data());
  for (std::size_t i = 0; i < axes.size; ++i) {
    const auto moments = homogeneous_moments(transfer.entries[i], transfer.emission, axes.length);
    for (std::size_t k = 0; k < 4; ++k) tables[k].set(i, i, moments[k].cast<float>());
  }
}

}  // namespace raytruth
