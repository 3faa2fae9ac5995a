// Tables of the quadratic gray-value model, 256 x 256 scalars, a random transfer function of 256 points. The peer of
// the opacities is algorithm 9 of the dissertation as a plain loop in binary32, for its seven radii and a > 0; ours are
// those of both signs and of the linear table. `slower` of the colours: the time of an entry over that of an entry of
// the exact table over three scalars, less 1. Look-ups: a march through 512 slabs, each looked up and composited,
// against the same with the table over three scalars.

#include "paired.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/tables/fast_quadratic_gray.hpp"
#include "raytruth/tables/fast_second_order.hpp"
#include "raytruth/tables/quadratic_gray_table.hpp"
#include "raytruth/tables/second_order.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth::benchmarks {
namespace {

constexpr std::size_t grays = 256;

TableAxes axes_of(std::size_t size) { return {.size = size, .low = 0, .high = largest_gray, .length = 1}; }

PiecewiseLinear random_points(std::size_t count) {
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto random = random_numbers(1, RandomStream::points, i);
    points.push_back({axes_of(count).scalar(i), {0.5 * random[0], {random[1], random[2], random[3]}}});
  }
  return PiecewiseLinear(points);
}

/// Algorithms 9 to 11 for one radius, its transfer function's items in a list.
class Algorithm9 {
 public:
  explicit Algorithm9(const PiecewiseLinear& transfer) {
    for (std::size_t i = 0; i < grays; ++i)
      items_[i] = static_cast<float>(transfer.at(static_cast<double>(i)).extinction);
  }

  double operator()(float radius, std::vector<float>& opacities) const {
    const float d = 1 / radius;
    for (int f = 0; f < static_cast<int>(grays); ++f)
      for (int b = f; b < static_cast<int>(grays); ++b) {
        const float opacity = 1 - std::exp(-radius * omega(f, b, d));
        opacities[static_cast<std::size_t>(f) * grays + static_cast<std::size_t>(b)] = opacity;
        opacities[static_cast<std::size_t>(b) * grays + static_cast<std::size_t>(f)] = opacity;
      }
    return static_cast<double>(opacities.back());
  }

 private:
  [[nodiscard]] float opt(float m, float t) const {
    float tn = t + 0.5F;
    const int i = std::min(static_cast<int>(tn), static_cast<int>(grays) - 1);
    const float f0 = items_[static_cast<std::size_t>(i == 0 ? 1 : i - 1)];
    const float f1 = items_[static_cast<std::size_t>(i)];
    const float f2 = items_[static_cast<std::size_t>(i == static_cast<int>(grays) - 1 ? i - 1 : i + 1)];
    tn -= static_cast<float>(i);
    const float value = (0.5F * (f2 + f0) - f1) * tn * tn + tn * (f1 - f0) + 0.5F * (f1 + f0);
    return value / (2.0F * std::sqrt(t - m));
  }
  [[nodiscard]] float levels(float m, int from, int to) const {
    float sum = 0;
    for (int i = from; i < to; ++i) {
      const auto s = static_cast<float>(i);
      sum += (opt(m, s) + 4.0F * opt(m, s + 0.5F) + opt(m, s + 1.0F)) * (1.0F / 6.0F);
    }
    return sum;
  }
  [[nodiscard]] float steps(float m, float low, float high, float step) const {
    float sum = 0.5F * (opt(m, low) + opt(m, high));
    for (int k = 1; k < 10; ++k) sum += opt(m, low + static_cast<float>(k) * step);
    return sum * step;
  }
  [[nodiscard]] float omega(int f, int b, float d) const {
    const float alpha = static_cast<float>(b - f) / d - d;
    const float m = static_cast<float>(f) - 0.25F * alpha * alpha;
    if (alpha == 0) return steps(m, m + 0.1F, m + 1, 0.1F) + levels(m, f + 1, b);
    if (alpha > 0) return levels(m, f, b);
    if (m < 0) return levels(m, 0, f) + levels(m, 0, b);
    const int index = static_cast<int>(std::ceil(m));
    const float fraction = static_cast<float>(index) - m;
    float sum = 0;
    if (fraction >= 1e-3F) sum = steps(m, m + 0.1F * fraction, static_cast<float>(index), 0.1F * fraction);
    sum += levels(m, fraction == 0 ? index + 1 : index, f);
    return 2 * sum + levels(m, f, b);
  }

  std::array<float, grays> items_{};
};

/// On one thread.
void opacities(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const PiecewiseLinear transfer = random_points(grays);
  const TableAxes axes = axes_of(grays);
  const RadiusAxis radius;
  const Algorithm9 algorithm(transfer);
  std::vector<float> table(grays * grays);
  run_paired(
      state,
      [&] {
        return static_cast<double>(
            quadratic_gray_opacities(axes, radius, transfer, *slab_kernel_versions().front()).back());
      },
      [&] {
        double last = 0;
        for (int k = -3; k <= 3; ++k) last += algorithm(static_cast<float>(std::ldexp(1.0, k)), table);
        return last;
      });
}
BENCHMARK(opacities)->UseManualTime()->Unit(benchmark::kMillisecond);

/// `slower`: the colours of an entry, associated emission, over those of an entry of the exact table over three
/// scalars.
void colors_of_an_entry(benchmark::State& state) {
  const auto size = static_cast<std::size_t>(state.range(0));
  const PiecewiseLinear transfer = random_points(size);
  const TableAxes axes = axes_of(size);
  QuadraticGrayTable<float> table(axes, {});
  Table3<float> three(axes);
  const SlabKernels& kernels = *slab_kernel_versions().front();
  run_paired(
      state,
      [&] {
        fill_quadratic_gray_table(table, transfer, Emission::associated, kernels);
        return static_cast<double>(table.values.back());
      },
      [&] {
        fill_exact_second_order_table(three, transfer, kernels);
        return static_cast<double>(three.values.back());
      });
  const double entries = static_cast<double>(table.values.size()) / static_cast<double>(three.values.size());
  state.counters["slower"] = 1 / (state.counters["speedup"] * entries) - 1;
}
BENCHMARK(colors_of_an_entry)->Arg(256)->UseManualTime()->Unit(benchmark::kMillisecond);

/// Seconds of a whole table of 256 x 256 scalars and 15 curvatures on all cores, plain emission.
void plain_colors(benchmark::State& state) {
  const PiecewiseLinear transfer = random_points(grays);
  QuadraticGrayTable<float> table(axes_of(grays), {});
  for ([[maybe_unused]] auto _ : state) {
    fill_quadratic_gray_table(table, transfer, Emission::plain, *slab_kernel_versions().front());
    benchmark::DoNotOptimize(table.values.back());
  }
}
BENCHMARK(plain_colors)->UseRealTime()->Unit(benchmark::kMillisecond);

/// `slower`: a look-up and a composite over the same with the table over three scalars, tables of about as many bytes.
void look_ups(benchmark::State& state) {
  constexpr std::size_t slabs = 512;
  const QuadraticGrayTable<float> table =
      quadratic_gray_table(random_points(64), axes_of(64), {}, Emission::associated);
  const Table3<float> three = second_order_table(random_points(40), axes_of(40), Emission::associated, Ideal{});
  const QuadraticGrayLookUp<float> look_up(table);
  std::vector<std::array<double, 3>> scalars(slabs);
  double s = 100;
  for (std::size_t i = 0; i < slabs; ++i) {
    const auto random = random_numbers(2, RandomStream::points, i);
    const auto next = [&](double r) { return s = std::clamp(s + 8 * (r - 0.5), 0.0, largest_gray); };
    scalars[i][0] = s;
    scalars[i][1] = next(random[0]);
    scalars[i][2] = next(random[1]);
  }
  const auto march = [&](const auto& slab_of) {
    Rules<double> rules;
    Rules<double>::vec4 ray = Rules<double>::vec4::Zero();
    for (const auto& slab : scalars) ray = rules.over(ray, 0.01 * slab_of(slab));
    return ray[3];
  };
  run_paired(
      state, [&] { return march(look_up); },
      [&] {
        return march([&](const std::array<double, 3>& slab) {
          return trilinear<double>(
              three.axes,
              [&](std::size_t front, std::size_t middle, std::size_t back) -> Rules<double>::vec4 {
                return three.at(front, middle, back).cast<double>();
              },
              slab);
        });
      });
  state.counters["slower"] = 1 / state.counters["speedup"] - 1;
}
BENCHMARK(look_ups)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace raytruth::benchmarks
