// Pre-integration tables against Lum's brute force, his subranges as a plain loop, and memset (Lum 2004, table 1; the
// dissertation, table 5.1).

#include "paired.hpp"
#include "raytruth/kernels/table_kernels.hpp"
#include "raytruth/tables/dissertation_linear.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/fast_tables.hpp"
#include "raytruth/tables/subrange.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace raytruth {
namespace {

constexpr double depth = 5;
constexpr int builds_per_timing = 8;
constexpr double seconds_per_timing = 0.05;
constexpr std::size_t largest_verified = 512;  // the table in binary64 beyond takes longer than what is timed

PiecewiseLinear transfer_function() { return random_transfer(depth, 1); }

TableAxes axes_of(const benchmark::State& state) { return {.size = static_cast<std::size_t>(state.range(0))}; }

/// A transfer function as a table of opacities, as Lum's builders take it.
struct OpacityTable {
  std::vector<float> opacity;
  std::vector<float> red;
  std::vector<float> green;
  std::vector<float> blue;

  explicit OpacityTable(const DiscreteTransfer& transfer) {
    for (const auto& [extinction, color] : transfer.intervals) {
      opacity.push_back(static_cast<float>(-std::expm1(-extinction)));
      red.push_back(static_cast<float>(color[0]));
      green.push_back(static_cast<float>(color[1]));
      blue.push_back(static_cast<float>(color[2]));
    }
  }
};

struct Texel {
  float red = 0;
  float green = 0;
  float blue = 0;
  float opacity = 0;
};

Texel over(const Texel& front, const Texel& back) {
  const float transmittance = 1 - front.opacity;
  return {front.red + transmittance * back.red, front.green + transmittance * back.green,
          front.blue + transmittance * back.blue, front.opacity + transmittance * back.opacity};
}

/// Interval k when a slab has so many; eq. 1.
Texel corrected(const OpacityTable& transfer, std::size_t k, float share) {
  const float opacity = 1 - std::pow(1 - transfer.opacity[k], share);
  return {opacity * transfer.red[k], opacity * transfer.green[k], opacity * transfer.blue[k], opacity};
}

void store(std::vector<float>& table, std::size_t size, std::size_t front, std::size_t back, const Texel& texel) {
  std::memcpy(table.data() + 4 * (back * size + front), &texel, sizeof(Texel));
}

/// Lum 2004, section 4.1: one opacity correction per composite.
void build_by_brute_force(const OpacityTable& transfer, std::size_t size, std::vector<float>& table, float length = 1) {
  for (std::size_t back = 0; back < size; ++back)
    for (std::size_t front = 0; front < size; ++front) {
      const std::size_t width = front < back ? back - front : front - back;
      const float share = length / static_cast<float>(width);
      Texel slab;
      for (std::size_t k = 0; k < width; ++k)
        slab = over(slab, corrected(transfer, front < back ? front + k : front - 1 - k, share));
      store(table, size, front, back, slab);
    }
}

/// Lum 2004, section 4.2, diagonal by diagonal: a plain loop, corrections once for each diagonal.
void build_by_plain_subranges(const OpacityTable& transfer, std::size_t size, std::vector<float>& table) {
  const std::size_t count = size - 1;
  std::vector<Texel> elements(count);
  std::vector<Texel> to_bin_end(count);
  for (std::size_t width = 1; width < size; ++width) {
    for (std::size_t k = 0; k < count; ++k) elements[k] = corrected(transfer, k, 1 / static_cast<float>(width));
    for (const bool backwards : {false, true}) {
      if (backwards) std::reverse(elements.begin(), elements.end());
      for (std::size_t bin = 0; bin + width <= count; bin += width) {
        Texel slab;
        for (std::size_t r = width; r-- > 0;) to_bin_end[r] = slab = over(elements[bin + r], slab);
        Texel behind;
        for (std::size_t r = 0; r < width && bin + width + r <= count; ++r) {
          if (r > 0) behind = over(behind, elements[bin + width + r - 1]);
          const std::size_t first = bin + r;
          const std::size_t front = backwards ? count - first : first;
          store(table, size, front, backwards ? front - width : front + width, over(to_bin_end[r], behind));
        }
      }
    }
  }
}

/// What all builders are given, and the table that they write to.
struct Builders {
  TableAxes axes;
  DiscreteTransfer transfer;
  OpacityTable opacities;
  Table<float> table;
  std::vector<float> plain_table;

  explicit Builders(const TableAxes& its_axes)
      : axes(its_axes),
        transfer(sampled(transfer_function(), axes, Emission::associated)),
        opacities(transfer),
        plain_table(4 * axes.size * axes.size) {
    build();
  }

  float build() {
    build_subrange_table(transfer, axes, table);
    return table.values[4];
  }
  float build_plain() {
    build_by_plain_subranges(opacities, axes.size, plain_table);
    return plain_table[4];
  }
  float build_brutally() {
    build_by_brute_force(opacities, axes.size, plain_table);
    return plain_table[4];
  }

  /// The largest error off the diagonal, which Lum's formula leaves open.
  [[nodiscard]] double error_of(const std::vector<float>& values) const {
    const auto truth = subrange_table<double>(transfer, axes);
    double error = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (i / 4 % (axes.size + 1) != 0)
        error = std::max(error, std::abs(static_cast<double>(values[i]) - truth.values[i]));
    return error;
  }
};

/// Whether the numbers are right: 10^-5, and 10^-4 for plain loops in binary32.
bool is_right(benchmark::State& state, Builders& builders) {
  if (builders.axes.size > largest_verified) return true;
  builders.build_plain();
  const double error = builders.error_of(builders.table.values);
  state.counters["error"] = error;
  const bool is_right = error <= 1e-5 && builders.error_of(builders.plain_table) <= 1e-4;
  if (!is_right) state.SkipWithError("the tables are wrong");
  return is_right;
}

tbb::global_control threads(int count) {
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)};
}

/// Goals: 1000 times at n = 1024, 2500 times at n = 2048. Claim lum-order, table 1.
void subranges_against_brute_force(benchmark::State& state) {
  const auto one_thread = threads(1);
  Builders builders(axes_of(state));
  if (!is_right(state, builders)) return;
  benchmarks::run_paired(
      state,
      [&] {
        float sum = 0;
        for (int i = 0; i < builds_per_timing; ++i) sum += builders.build();
        return sum;
      },
      [&] { return builders.build_brutally(); });
  state.counters["subject_seconds"] = state.counters["subject_seconds"] / builds_per_timing;
  state.counters["speedup"] = state.counters["speedup"] * builds_per_timing;
  const auto brute_force = static_cast<double>(state.range(0));
  state.counters["brute_force_composites"] = (brute_force - 1) * brute_force * (brute_force + 1) / 3;
}
BENCHMARK(subranges_against_brute_force)
    ->RangeMultiplier(2)
    ->Range(32, 512)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(subranges_against_brute_force)
    ->Arg(1024)
    ->Arg(2048)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// A table over front, back and 128 distances up to sqrt(3), each distance by itself.
struct CellTables {
  static constexpr std::size_t distances = 128;
  Builders builders;
  std::vector<Table<float>> slices;
  std::vector<Table<float>> singles;

  explicit CellTables(const TableAxes& axes)
      : builders(axes), slices(distances, builders.table), singles(distances, builders.table) {}

  [[nodiscard]] static double distance(std::size_t i) {
    return 1.7320508 * static_cast<double>(i + 1) / static_cast<double>(distances);
  }
  float build() {
    float sum = 0;
    for (std::size_t i = 0; i < distances; ++i) {
      TableAxes axes = builders.axes;
      axes.length = distance(i);
      build_subrange_table(builders.transfer, axes, slices[i]);
      sum += slices[i].values[4];
    }
    return sum;
  }
  float build_brutally() {
    float sum = 0;
    for (std::size_t i = 0; i < distances; ++i) {
      build_by_brute_force(builders.opacities, builders.axes.size, builders.plain_table,
                           static_cast<float>(distance(i)));
      sum += builders.plain_table[4];
    }
    return sum;
  }
  /// As many tables of one distance, each kept in memory of its own as the slices are: 32 MiB do not stay in caches,
  /// where one table that is built again and again takes two thirds of the time.
  float build_single_ones() {
    float sum = 0;
    for (Table<float>& table : singles) {
      build_subrange_table(builders.transfer, builders.axes, table);
      sum += table.values[4];
    }
    return sum;
  }
};

/// Goal: 150 times at n = 128.
void cell_tables_against_brute_force(benchmark::State& state) {
  const auto one_thread = threads(1);
  CellTables tables(axes_of(state));
  if (!is_right(state, tables.builders)) return;
  benchmarks::run_paired(
      state, [&] { return tables.build(); }, [&] { return tables.build_brutally(); });
}
BENCHMARK(cell_tables_against_brute_force)->Arg(128)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);

/// Goal: at most 1.1 times as long as 128 tables of one distance: a speedup of 0.91.
void cell_tables_against_single_ones(benchmark::State& state) {
  const auto one_thread = threads(1);
  CellTables tables(axes_of(state));
  tables.build();
  benchmarks::run_paired(
      state, [&] { return tables.build(); }, [&] { return tables.build_single_ones(); });
}
BENCHMARK(cell_tables_against_single_ones)
    ->Arg(128)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

/// Goals: 6 times at n = 1024 and 2048; at most 3.5 times memset at n = 2048.
void subranges_against_plain_ones(benchmark::State& state) {
  const auto one_thread = threads(1);
  Builders builders(axes_of(state));
  if (!is_right(state, builders)) return;
  const benchmarks::Peer plain{"plain_subranges", [&] { return static_cast<double>(builders.build_plain()); }};
  benchmarks::run_against_fastest(state, [&] { return builders.build(); }, {plain});
}
BENCHMARK(subranges_against_plain_ones)
    ->RangeMultiplier(2)
    ->Range(32, 2048)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

void subranges_against_memset(benchmark::State& state) {
  const auto one_thread = threads(1);
  Builders builders(axes_of(state));
  if (!is_right(state, builders)) return;
  benchmarks::run_paired(
      state, [&] { return builders.build(); },
      [&] {
        std::memset(builders.table.values.data(), 0, builders.table.values.size() * sizeof(float));
        return builders.table.values[4];
      });
  state.counters["times_memset"] = 1 / state.counters["speedup"];
}
BENCHMARK(subranges_against_memset)
    ->Arg(256)
    ->Arg(1024)
    ->Arg(2048)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

/// The lower levels of x86-64 against the best one.
void levels_of_subranges(benchmark::State& state) {
  const auto one_thread = threads(1);
  Builders builders(axes_of(state));
  std::vector<benchmarks::Peer> lower;
  const auto& versions = table_kernel_versions();
  for (std::size_t i = 1; i < versions.size(); ++i)
    lower.push_back({i + 1 == versions.size() ? "baseline" : "x86_64_v3", [&builders, kernels = versions[i]] {
                       build_subrange_table(builders.transfer, builders.axes, builders.table, kernels);
                       return static_cast<double>(builders.table.values[4]);
                     }});
  if (lower.empty()) return state.SkipWithError("this processor has one level only");
  benchmarks::run_against_fastest(
      state, [&] { return builders.build(); }, lower);
}
BENCHMARK(levels_of_subranges)
    ->Arg(256)
    ->Arg(2048)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

/// Calls build() on one thread and on two.
template <class Build>
void run_on_two_threads(benchmark::State& state, const Build& build) {
  const auto built_on = [&](int count) {
    const auto limit = threads(count);
    return build();
  };
  benchmarks::run_paired(
      state, [&] { return built_on(2); }, [&] { return built_on(1); });
}

void subranges_on_two_threads(benchmark::State& state) {
  Builders builders(axes_of(state));
  run_on_two_threads(state, [&] { return builders.build(); });
}
BENCHMARK(subranges_on_two_threads)
    ->Arg(256)
    ->Arg(1024)
    ->Arg(2048)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

void moments_on_two_threads(benchmark::State& state) {
  const Builders builders(axes_of(state));
  std::array<Table<float>, 4> tables;
  run_on_two_threads(state, [&] {
    build_moment_tables(builders.transfer, builders.axes, tables);
    return tables[3].values[4];
  });
}
BENCHMARK(moments_on_two_threads)
    ->Arg(256)
    ->Arg(512)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

void exact_on_two_threads(benchmark::State& state) {
  const PiecewiseLinear transfer = transfer_function();
  run_on_two_threads(state, [&] { return exact_table(transfer, axes_of(state), Emission::associated).values[4]; });
}
BENCHMARK(exact_on_two_threads)->Arg(256)->UseManualTime()->MinTime(seconds_per_timing)->Unit(benchmark::kMillisecond);

/// Fresh memory against a kept table.
void rebuilding_against_a_fresh_table(benchmark::State& state) {
  const auto one_thread = threads(1);
  Builders builders(axes_of(state));
  benchmarks::run_paired(
      state, [&] { return builders.build(); },
      [&] {
        Table<float> fresh;
        build_subrange_table(builders.transfer, builders.axes, fresh);
        return fresh.values[4];
      });
}
BENCHMARK(rebuilding_against_a_fresh_table)
    ->Arg(256)
    ->Arg(2048)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

/// All moments of an 8-bit transfer function, against the unshaded table and its plain loop, and against clearing the
/// memory of the four tables. Goal: 4 times a plain table at most. It is arithmetic that bounds them: 17 sums where a
/// plain table has 4.
void moments_against_subranges(benchmark::State& state) {
  const auto one_thread = threads(1);
  Builders builders(axes_of(state));
  std::array<Table<float>, 4> tables;
  const benchmarks::Peer fast{"subranges", [&] { return static_cast<double>(builders.build()); }};
  const benchmarks::Peer plain{"plain_subranges", [&] { return static_cast<double>(builders.build_plain()); }};
  const benchmarks::Peer memset{"memset", [&] {
                                  for (Table<float>& table : tables)
                                    std::memset(table.values.data(), 0, table.values.size() * sizeof(float));
                                  return static_cast<double>(tables[3].values[4]);
                                }};
  const auto build = [&] {
    build_moment_tables(builders.transfer, builders.axes, tables);
    return tables[3].values[4];
  };
  build();
  benchmarks::run_against_fastest(state, build, {fast, plain, memset});
  for (const char* const name : {"subranges", "plain_subranges", "memset"})
    state.counters[std::string("times_") + name] = 1 / state.counters[std::string("speedup_over_") + name];
}
BENCHMARK(moments_against_subranges)
    ->Arg(128)
    ->Arg(256)
    ->Arg(512)
    ->UseManualTime()
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

/// Claim diss-linear-lut-time, table 5.1: the corrected tables, all distances, binary64.
void dissertation_linear(benchmark::State& state) {
  const auto one_thread = threads(1);
  const PiecewiseLinear transfer = transfer_function();
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(dissertation_linear_table(transfer, axes_of(state), Emission::associated,
                                                       DissertationAlgorithm::corrected,
                                                       DistanceInterpolation::logarithm));
}
BENCHMARK(dissertation_linear)
    ->RangeMultiplier(2)
    ->Range(32, 256)
    ->MinTime(seconds_per_timing)
    ->Unit(benchmark::kMillisecond);

void exact(benchmark::State& state) {
  const auto one_thread = threads(1);
  const PiecewiseLinear transfer = transfer_function();
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(exact_table(transfer, axes_of(state), Emission::associated));
}
BENCHMARK(exact)->RangeMultiplier(2)->Range(32, 2048)->MinTime(seconds_per_timing)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace raytruth
