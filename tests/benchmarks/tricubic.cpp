// Exact tricubic chains against tricubic samples, and virtual samples against true ones (Lee 2010, figure 4 and table
// 1).

#include "raytruth/signals/tricubic.hpp"
#include "paired.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/tricubic_value.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {
namespace {

constexpr int ray_length = 30;
constexpr std::uint64_t ray_count = 1024;

const Grid& field() {
  static const Grid smooth = random_field(64, 1, 1);
  return smooth;
}

/// Rays that stay two voxels away from the border, so that no sample needs clamping; directions of length 1.
const std::vector<Ray>& inner_rays() {
  static const std::vector<Ray> all = [] {
    constexpr std::int64_t margin = 2;
    Grid inside{.size = field().size, .spacing = {1, 1, 1}, .values = {}};
    for (std::int64_t& size : inside.size) size -= 2 * margin;
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; i < ray_count; ++i) {
      rays.push_back(random_ray(inside, ray_length, 1, i));
      for (double& x : rays.back().origin) x += static_cast<double>(margin);
    }
    return rays;
  }();
  return all;
}

std::array<double, 3> point_at(const Ray& ray, double t) {
  return {ray.origin[0] + t * ray.direction[0], ray.origin[1] + t * ray.direction[1],
          ray.origin[2] + t * ray.direction[2]};
}

/// The cubic B-spline at a point away from the border, as a careful renderer computes it: weights once for each axis,
/// and 16 + 4 + 1 sums of four products.
double bspline_sample(const Grid& grid, const std::array<double, 3>& point) {
  std::array<std::array<double, 4>, 3> weight{};
  std::array<std::int64_t, 3> first{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cell = std::floor(point[axis]);
    const double u = point[axis] - cell;
    const double v = 1 - u;
    first[axis] = static_cast<std::int64_t>(cell) - 1;
    weight[axis] = {v * v * v * (1.0 / 6), 2.0 / 3 - u * u * (1 - 0.5 * u), 2.0 / 3 - v * v * (1 - 0.5 * v),
                    u * u * u * (1.0 / 6)};
  }
  const std::int64_t row = grid.size[0];
  const std::int64_t slice = row * grid.size[1];
  const double* const corner = grid.values.data() + first[2] * slice + first[1] * row + first[0];
  double sum = 0;
  for (std::int64_t k = 0; k < 4; ++k) {
    double in_slice = 0;
    for (std::int64_t j = 0; j < 4; ++j) {
      const double* const voxels = corner + k * slice + j * row;
      const double in_row =
          (weight[0][0] * voxels[0] + weight[0][1] * voxels[1]) + (weight[0][2] * voxels[2] + weight[0][3] * voxels[3]);
      in_slice += weight[1][static_cast<std::size_t>(j)] * in_row;
    }
    sum += weight[2][static_cast<std::size_t>(k)] * in_slice;
  }
  return sum;
}

/// Whether it is what `tricubic_value` says, along all rays.
bool samples_are_right() {
  for (const Ray& ray : inner_rays())
    for (int t = 0; t <= ray_length; ++t) {
      const auto point = point_at(ray, t);
      if (!(std::abs(bspline_sample(field(), point) - tricubic_value(field(), CubicKernel::bspline, point)) < 1e-14))
        return false;
    }
  return true;
}

/// The sum of true samples at t = 0, 1/rate, ... before the ray's end.
double sum_of_true_samples(const Ray& ray, int rate) {
  double sum = 0;
  for (int i = 0; i < ray_length * rate; ++i)
    sum += bspline_sample(field(), point_at(ray, static_cast<double>(i) / rate));
  return sum;
}

/// The sum of samples in the same places, a true one at every voxel and `Count` virtual ones behind it: as it goes on,
/// the ray takes one new true sample, ahead of the interval it is in (Lee 2010, section 4).
template <int Count>
double sum_of_virtual_samples(const Ray& ray) {
  Rules<double> rules;
  const auto sample = [&ray](int t) { return bspline_sample(field(), point_at(ray, t)); };
  double front = sample(0);
  double back = sample(1);
  double after = sample(2);
  double before = rules.virtual_catmull_rom_ghost(front, back, after);
  double sum = 0;
  for (int k = 0; k < ray_length; ++k) {
    const auto curve = rules.virtual_catmull_rom(before, front, back, after);
    sum += front;
    for (int i = 1; i <= Count; ++i) sum += rules.virtual_sample(curve, static_cast<double>(i) / (Count + 1));
    const double next = k + 3 <= ray_length ? sample(k + 3) : rules.virtual_catmull_rom_ghost(after, back, front);
    before = front;
    front = back;
    back = after;
    after = next;
  }
  return sum;
}

template <class OfRay>
double over_all_rays(OfRay&& of_ray) {
  double sum = 0;
  for (const Ray& ray : inner_rays()) sum += of_ray(ray);
  return sum;
}

double nanoseconds_per_sample(double seconds, int rate) {
  return 1e9 * seconds / static_cast<double>(ray_count * ray_length * static_cast<std::uint64_t>(rate));
}

/// The chain of a ray, against tricubic samples one voxel apart along it.
void exact_tricubic_chain_against_samples(benchmark::State& state) {
  if (!samples_are_right()) return state.SkipWithError("the samples are wrong");
  Chain<9> chain;
  std::size_t cells = 0;
  benchmarks::run_paired(
      state,
      [&] {
        cells = 0;
        for (const Ray& ray : inner_rays()) {
          trace_tricubic(field(), CubicKernel::bspline, ray, chain);
          cells += chain.pieces.size();
        }
        return cells;
      },
      [] { return over_all_rays([](const Ray& ray) { return sum_of_true_samples(ray, 1); }); });
  const double seconds = state.counters["subject_seconds"];
  state.counters["rays_per_second"] = static_cast<double>(ray_count) / seconds;
  state.counters["nanoseconds_per_cell"] = 1e9 * seconds / static_cast<double>(cells);
  state.counters["nanoseconds_per_sample"] = nanoseconds_per_sample(state.counters["peer_seconds"], 1);
}
BENCHMARK(exact_tricubic_chain_against_samples)->UseManualTime()->Unit(benchmark::kMillisecond);

/// As many samples of a ray, most of them virtual, against true ones. Sampling alone: with gradients for shading, seven
/// times as many fetches, true samples cost still more; with classification and compositing both do.
template <int Count>
void virtual_samples_against_true(benchmark::State& state) {
  if (!samples_are_right()) return state.SkipWithError("the samples are wrong");
  benchmarks::run_paired(
      state, [] { return over_all_rays(sum_of_virtual_samples<Count>); },
      [] { return over_all_rays([](const Ray& ray) { return sum_of_true_samples(ray, Count + 1); }); });
  state.counters["nanoseconds_per_sample"] = nanoseconds_per_sample(state.counters["subject_seconds"], Count + 1);
  state.counters["nanoseconds_per_true_sample"] = nanoseconds_per_sample(state.counters["peer_seconds"], Count + 1);
}
// Claim lee-speedup: 2.5 to 3.3 with three virtual samples.
BENCHMARK_TEMPLATE(virtual_samples_against_true, 3)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(virtual_samples_against_true, 7)->UseManualTime()->Unit(benchmark::kMillisecond);

/// Three virtual samples per voxel against seven: `extra_cost` is claim lee-vs7-cost, 0.101 for whole frames on Lee's
/// GPU.
void three_virtual_samples_against_seven(benchmark::State& state) {
  benchmarks::run_paired(
      state, [] { return over_all_rays(sum_of_virtual_samples<3>); },
      [] { return over_all_rays(sum_of_virtual_samples<7>); });
  state.counters["extra_cost"] = state.counters["speedup"] - 1;
}
BENCHMARK(three_virtual_samples_against_seven)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace raytruth
