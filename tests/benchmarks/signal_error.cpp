// The exact walk, exact xi against the papers' way of computing it, and two threads against one.

#include "raytruth/metrics/signal_error.hpp"
#include "experiments/measure.hpp"
#include "paired.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/signals/trilinear_value.hpp"

#include <tbb/task_arena.h>

#include <cmath>
#include <vector>

namespace raytruth {
namespace {

const Grid& field(double smoothing) {
  static const Grid white = random_field(64, 0, 1);
  static const Grid smooth = random_field(64, 1, 1);
  return smoothing == 0 ? white : smooth;
}

std::vector<Ray> random_rays(const Grid& grid, double length, std::uint64_t count) {
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i) rays.push_back(random_ray(grid, length, 1, i));
  return rays;
}

/// The chain of a ray, against fetching trilinear samples one voxel apart along it.
void exact_walk_against_samples(benchmark::State& state) {
  const Grid& grid = field(0);
  const auto rays = random_rays(grid, 30, 1024);
  Chain<3> chain;
  std::size_t cells = 0;
  benchmarks::run_paired(
      state,
      [&] {
        cells = 0;
        for (const Ray& ray : rays) {
          trace_trilinear(grid, ray, chain);
          cells += chain.pieces.size();
        }
        return cells;
      },
      [&] {
        double sum = 0;
        for (const Ray& ray : rays)
          for (int t = 0; t < 30; ++t)
            sum += trilinear_value<double>(grid,
                                           {ray.origin[0] + t * ray.direction[0], ray.origin[1] + t * ray.direction[1],
                                            ray.origin[2] + t * ray.direction[2]});
        return sum;
      });
  const double seconds = state.counters["subject_seconds"];
  state.counters["rays_per_second"] = static_cast<double>(rays.size()) / seconds;
  state.counters["nanoseconds_per_cell"] = 1e9 * seconds / static_cast<double>(cells);
  state.counters["nanoseconds_per_sample"] =
      1e9 * state.counters["peer_seconds"] / (30 * static_cast<double>(rays.size()));
}
BENCHMARK(exact_walk_against_samples)->UseManualTime()->Unit(benchmark::kMillisecond);

/// xi of one scheme by a zero-order sum of |s - s^| at `rate` points per voxel (El Hajjar 2008, section 3.2), the
/// signal fetched from the grid as a renderer does.
template <class S>
double xi_by_sum(const Grid& grid, const Ray& ray, const Samples<double>& samples, const Chain<3>& approximation,
                 double rate) {
  const auto count = static_cast<std::int64_t>(std::ceil(ray.length * rate));
  const double step = ray.length / static_cast<double>(count);
  double sum = 0;
  std::size_t interval = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const double t = (static_cast<double>(i) + 0.5) * step;
    while (interval + 1 < samples.interval_count() && samples.positions[interval + 1].high <= t) ++interval;
    const auto& piece = approximation.pieces[interval];
    const auto& b = piece.polynomial.coefficients;
    const double u = (t - piece.start.high) / piece.length;
    const double v = 1 - u;
    const double approximate = v * v * v * b[0] + 3 * u * v * (v * b[1] + u * b[2]) + u * u * u * b[3];
    const auto value =
        trilinear_value<double>(grid, {ray.origin[0] + t * ray.direction[0], ray.origin[1] + t * ray.direction[1],
                                       ray.origin[2] + t * ray.direction[2]});
    sum += std::abs(value - approximate);
  }
  return sum * step;
}

/// Exact xi, walk and samples included, against the sum at the lowest rate 2^k at which it has six digits: whose
/// relative error is at most 1e-6, as root mean square over the rays.
template <class S>
void exact_xi_against_sums(benchmark::State& state) {
  const Grid& grid = field(static_cast<double>(state.range(0)));
  const auto rays = random_rays(grid, 8.5, 64);
  Chain<3> signal;
  Samples<double> samples;
  Chain<3> approximation;
  const auto prepare = [&](const Ray& ray) {
    trace_trilinear(grid, ray, signal);
    sample_cells(signal, samples);
    approximate<S>(signal, samples, approximation);
  };
  const auto relative_error = [&](double rate) {
    double sum = 0;
    for (const Ray& ray : rays) {
      prepare(ray);
      const double exact = xi(signal, approximation);
      const double relative = xi_by_sum<S>(grid, ray, samples, approximation, rate) / exact - 1;
      sum += relative * relative;
    }
    return std::sqrt(sum / static_cast<double>(rays.size()));
  };
  double rate = 16;
  while (relative_error(rate) > 1e-6) rate *= 2;
  benchmarks::run_paired(
      state,
      [&] {
        double sum = 0;
        for (const Ray& ray : rays) {
          prepare(ray);
          sum += xi(signal, approximation);
        }
        return sum;
      },
      [&] {
        double sum = 0;
        for (const Ray& ray : rays) {
          prepare(ray);
          sum += xi_by_sum<S>(grid, ray, samples, approximation, rate);
        }
        return sum;
      });
  state.counters["points_per_voxel"] = rate;
  state.counters["rays_per_second"] = static_cast<double>(rays.size()) / state.counters["subject_seconds"];
}
// The argument is the field's smoothing in voxels.
BENCHMARK_TEMPLATE(exact_xi_against_sums, Order1)
    ->ArgName("smoothing")
    ->Arg(0)
    ->Arg(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(exact_xi_against_sums, Order2)
    ->ArgName("smoothing")
    ->Arg(0)
    ->Arg(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// The measure behind the xi studies on two threads, against one.
void two_threads_against_one(benchmark::State& state) {
  const JsonReader options = JsonReader::from_text(R"({"kind": "signal_error"})", "benchmark");
  const std::string document =
      R"({"schemes": ["order0_left", "order0_right", "order0_mid", "order1", "order2"], "samplings": [{"kind": "cells"}]})";
  const Experiment experiment{.name = "benchmark",
                              .seed = 1,
                              .fields = {},
                              .rays = {.count = 8192, .length = 8.5},
                              .transfers = {},
                              .samplings = {{.kind = "cells", .step = {}}},
                              .schemes = {"order0_left", "order0_right", "order0_mid", "order1", "order2"},
                              .programs = {},
                              .measures = {},
                              .claims = {},
                              .checks = {},
                              .json = JsonReader::from_text(document, "benchmark")};
  const Field white{.name = "white", .grid = field(0), .data_range = {0, 1}};
  const Measure& signal_error = measure_of(options);
  const auto asked = signal_error.ask(signal_error, experiment, options);
  const auto measure = [&] { return asked->rows(experiment, white, 0).size(); };
  tbb::task_arena one(1);
  tbb::task_arena two(2);
  benchmarks::run_paired(
      state, [&] { return two.execute(measure); }, [&] { return one.execute(measure); });
}
BENCHMARK(two_threads_against_one)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace raytruth
