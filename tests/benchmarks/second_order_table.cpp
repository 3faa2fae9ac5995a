// Builds of El Hajjar's table of second order (fig. 6), RGBA in binary32, N iterations per entry. The peer is a plain
// loop as section 6.2 describes it: for each entry the parabola's coefficients, and N times Horner's rule, the nearest
// entry of a transfer function whose opacities are corrected to the step beforehand, and a composite; so the peer
// leaves out the interpolation between entries and the exponentials that the subject does. `same_numbers` is the same
// loop with both, as the subject has them. And exact tables against the same plain loop, whose errors they do not have.
// Random transfer function of as many entries as the table has along an axis.

#include "paired.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/tables/fast_second_order.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth::benchmarks {
namespace {

TableAxes axes_of(std::size_t size) { return {.size = size, .low = 0, .high = 1, .length = 1}; }

/// The studies' random transfer function at this many entries.
PiecewiseLinear transfer_of(const TableAxes& axes) {
  const PiecewiseLinear all = random_transfer(5, 1);
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < axes.size; ++i) points.push_back({axes.scalar(i), all.at(axes.scalar(i))});
  return PiecewiseLinear(std::move(points));
}

/// What a benchmark's state asks for: a size, and N.
struct Asked {
  explicit Asked(const benchmark::State& state)
      : axes(axes_of(static_cast<std::size_t>(state.range(0)))), transfer(transfer_of(axes)) {}

  TableAxes axes;
  PiecewiseLinear transfer;
};

int iterations_of(const benchmark::State& state) { return static_cast<int>(state.range(1)); }

/// Calls entry(front, middle, back, texel) for all.
template <class Entry>
double for_each_entry(Table3<float>& table, const Entry& entry) {
  const std::size_t n = table.axes.size;
  for (std::size_t back = 0; back < n; ++back)
    for (std::size_t middle = 0; middle < n; ++middle)
      for (std::size_t front = 0; front < n; ++front)
        entry(static_cast<float>(front), static_cast<float>(middle), static_cast<float>(back),
              table.texel(front, middle, back));
  return static_cast<double>(table.values.back());
}

/// The parabola through the three scalars of an entry at t = 0, 1/2 and 1.
struct Parabola {
  float a, b, front;

  Parabola(float its_front, float middle, float back)
      : a(2 * its_front - 4 * middle + 2 * back), b(-3 * its_front + 4 * middle - back), front(its_front) {}
  float operator()(float t) const { return (a * t + b) * t + front; }
};

double plain_loop(const PiecewiseLinear& transfer, Table3<float>& table, int iterations) {
  const std::size_t n = table.axes.size;
  std::vector<std::array<float, 4>> corrected(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Optics optics = transfer.at(table.axes.scalar(i));
    const double opacity = -std::expm1(-optics.extinction * table.axes.length / iterations);
    for (Eigen::Index c = 0; c < 3; ++c)
      corrected[i][static_cast<std::size_t>(c)] = static_cast<float>(opacity * optics.color[c]);
    corrected[i][3] = static_cast<float>(opacity);
  }
  const auto last = static_cast<float>(n - 1);
  return for_each_entry(table, [&](float front, float middle, float back, float* texel) {
    std::array<float, 4> slab{};
    const Parabola parabola(front, middle, back);
    for (int k = 0; k < iterations; ++k) {
      const float at =
          std::min(std::max(parabola((static_cast<float>(k) + 0.5F) / static_cast<float>(iterations)), 0.0F), last);
      // NOLINTNEXTLINE(bugprone-incorrect-roundings): as such loops have it, and nothing is negative
      const auto& step = corrected[static_cast<std::size_t>(static_cast<int>(at + 0.5F))];
      const float transmittance = 1 - slab[3];
      for (std::size_t c = 0; c < 4; ++c) slab[c] += transmittance * step[c];
    }
    std::copy(slab.begin(), slab.end(), texel);
  });
}

double same_numbers(const PiecewiseLinear& transfer, Table3<float>& table, int iterations) {
  const std::size_t n = table.axes.size;
  std::vector<std::array<float, 4>> entries(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const Optics optics = transfer.at(table.axes.scalar(i));
    entries[i] = {static_cast<float>(optics.color[0]), static_cast<float>(optics.color[1]),
                  static_cast<float>(optics.color[2]), static_cast<float>(optics.extinction)};
  }
  entries[n] = entries[n - 1];
  const auto last = static_cast<float>(n - 1);
  const float step = static_cast<float>(table.axes.length) / static_cast<float>(iterations);
  return for_each_entry(table, [&](float front, float middle, float back, float* texel) {
    std::array<float, 4> slab{};
    const Parabola parabola(front, middle, back);
    for (int k = 0; k < iterations; ++k) {
      const float at =
          std::min(std::max(parabola((static_cast<float>(k) + 0.5F) / static_cast<float>(iterations)), 0.0F), last);
      const auto first = static_cast<std::size_t>(static_cast<int>(at));
      const float weight = at - static_cast<float>(first);
      std::array<float, 4> optics{};
      for (std::size_t c = 0; c < 4; ++c)
        optics[c] = entries[first][c] + weight * (entries[first + 1][c] - entries[first][c]);
      const float absorbed = (1 - slab[3]) * -std::expm1(-optics[3] * step);
      for (std::size_t c = 0; c < 3; ++c) slab[c] += absorbed * optics[c];
      slab[3] += absorbed;
    }
    std::copy(slab.begin(), slab.end(), texel);
  });
}

struct Difference {
  double largest = 0;
  double mean = 0;
};

Difference difference_of(const Table3<float>& a, const Table3<float>& b) {
  Difference result;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double difference = std::abs(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i]));
    result.largest = std::max(result.largest, difference);
    result.mean += difference / static_cast<double>(a.values.size());
  }
  return result;
}

tbb::global_control threads(std::size_t count) { return {tbb::global_control::max_allowed_parallelism, count}; }

template <class Peer>
void run(benchmark::State& state, const Peer& peer, const Difference& most) {
  const Asked asked(state);
  const int iterations = iterations_of(state);
  const auto one_thread = threads(1);
  Table3<float> of_peer(asked.axes);
  Table3<float> of_subject(asked.axes);
  const auto fast = [&] {
    fill_second_order_table(of_subject, asked.transfer, {.count = iterations}, *slab_kernel_versions().front());
    return static_cast<double>(of_subject.values.back());
  };
  run_paired(state, fast, [&] { return peer(asked.transfer, of_peer, iterations); });
  const Difference difference = difference_of(of_subject, of_peer);
  if (!(difference.largest <= most.largest && difference.mean <= most.mean))
    return state.SkipWithError("the two do not agree");
  state.counters["largest_difference"] = difference.largest;
  state.counters["mean_difference"] = difference.mean;
}

/// Nearest entries against linear ones: single entries differ as much as a random transfer function's neighbours do,
/// their mean hardly.
void fast_against_plain_loop(benchmark::State& state) { run(state, plain_loop, {.largest = 0.5, .mean = 0.05}); }
BENCHMARK(fast_against_plain_loop)
    ->ArgNames({"size", "iterations"})
    ->ArgsProduct({{64, 256}, {64}})
    ->ArgsProduct({{64}, {8, 16, 32, 128, 256}})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void fast_against_same_numbers(benchmark::State& state) { run(state, same_numbers, {.largest = 2e-5, .mean = 1e-6}); }
BENCHMARK(fast_against_same_numbers)
    ->ArgNames({"size", "iterations"})
    ->Args({64, 64})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// The exact table against the plain loop. Goal: speedup >= 1 / 1.5 at N = 64. `largest_error` is that of entries drawn
/// at random, against certified ones.
void exact_against_plain_loop(benchmark::State& state) {
  constexpr std::uint64_t certified_entries = 20000;
  const auto [axes, transfer] = Asked(state);
  const int iterations = iterations_of(state);
  const auto one_thread = threads(1);
  Table3<float> of_peer(axes);
  Table3<float> of_subject(axes);
  const auto exact = [&] {
    fill_exact_second_order_table(of_subject, transfer, *slab_kernel_versions().front());
    return static_cast<double>(of_subject.values.back());
  };
  exact();
  SecondOrderSlabs slabs(transfer, axes, Emission::associated);
  double largest_error = 0;
  for (std::uint64_t i = 0; i < certified_entries; ++i) {
    const auto random = random_numbers(1, RandomStream::points, i);
    std::array<std::size_t, 3> entry{};
    for (std::size_t k = 0; k < 3; ++k) entry[k] = static_cast<std::size_t>(random[k] * static_cast<double>(axes.size));
    const auto expected = slabs({axes.scalar(entry[0]), axes.scalar(entry[1]), axes.scalar(entry[2])}, Ideal{});
    largest_error = std::max(largest_error,
                             (of_subject.at(entry[0], entry[1], entry[2]).cast<double>() - expected).abs().maxCoeff());
  }
  if (!(largest_error <= 5e-6)) return state.SkipWithError("the exact slabs are wrong");
  run_paired(state, exact, [&] { return plain_loop(transfer, of_peer, iterations); });
  state.counters["largest_error"] = largest_error;
}
BENCHMARK(exact_against_plain_loop)
    ->ArgNames({"size", "iterations"})
    ->Args({64, 64})
    ->Args({256, 64})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// N iterations, 0: exact.
void two_threads_against_one(benchmark::State& state) {
  const Asked asked(state);
  const int iterations = iterations_of(state);
  Table3<float> table(asked.axes);
  const auto on = [&](std::size_t count) {
    const auto limit = threads(count);
    const SlabKernels& kernels = *slab_kernel_versions().front();
    if (iterations > 0)
      fill_second_order_table(table, asked.transfer, {.count = iterations}, kernels);
    else
      fill_exact_second_order_table(table, asked.transfer, kernels);
    return static_cast<double>(table.values.back());
  };
  run_paired(
      state, [&] { return on(2); }, [&] { return on(1); });
}
BENCHMARK(two_threads_against_one)
    ->ArgNames({"size", "iterations"})
    ->ArgsProduct({{128}, {64, 0}})
    ->Iterations(2)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Exact slabs against certified ones, entry by entry.
void exact_against_certified(benchmark::State& state) {
  const auto [axes, transfer] = Asked(state);
  const auto one_thread = threads(1);
  Table3<float> table(axes);
  run_paired(
      state,
      [&] {
        fill_exact_second_order_table(table, transfer, *slab_kernel_versions().front());
        return static_cast<double>(table.values.back());
      },
      [&] {
        SecondOrderSlabs slabs(transfer, axes, Emission::associated);
        double sum = 0;
        for (std::size_t back = 0; back < axes.size; ++back)
          for (std::size_t middle = 0; middle < axes.size; ++middle)
            for (std::size_t front = 0; front < axes.size; ++front)
              sum += slabs({axes.scalar(front), axes.scalar(middle), axes.scalar(back)}, Ideal{})[3];
        return sum;
      });
}
BENCHMARK(exact_against_certified)
    ->ArgNames({"size"})
    ->Arg(32)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace raytruth::benchmarks
