// Look-ups of a pre-integration table with their composites, per slab: a plain loop over one ray, against four rays in
// the registers of this processor. What is timed: scalars in, colour and opacity of the rays out; 4096 slabs a ray,
// table of 256 x 256 binary32 RGBA (1 MiB). `coherent`: the four rays are neighbours through a smooth field; `random`:
// every scalar is drawn by itself.

#include "paired.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace raytruth::benchmarks {
namespace {

constexpr std::size_t slab_count = 4096;
constexpr std::size_t table_size = 256;

const Table<float>& table() {
  static const Table<float> made = rounded(exact_table(
      random_transfer(0.1, 1), {.size = table_size, .low = 0, .high = 1, .length = 1}, Emission::associated));
  return made;
}

/// Scalars of four rays side by side.
std::vector<float> scalars_of(bool is_coherent) {
  std::vector<float> scalars;
  for (std::uint64_t k = 0; k <= slab_count; ++k) {
    const auto numbers = random_numbers(1, RandomStream::rays, k);
    for (std::size_t ray = 0; ray < 4; ++ray) {
      const double wave = 0.5 + 0.45 * std::sin(0.05 * static_cast<double>(k) + 0.02 * static_cast<double>(ray));
      scalars.push_back(static_cast<float>(is_coherent ? wave : numbers[ray]));
    }
  }
  return scalars;
}

/// One ray, channel by channel.
std::array<float, 4> march_one(const SlabTable& table, const float* scalars, std::size_t stride, std::size_t slabs) {
  struct Place {
    std::size_t first;
    float weight;
  };
  const auto place = [&table](float s) {
    const auto last = static_cast<float>(table.size - 1);
    const float position = std::min(std::max(s * table.scale + table.offset, 0.0F), last);
    const auto first = static_cast<std::size_t>(static_cast<int>(std::min(position, last - 1.0F)));
    return Place{first, position - static_cast<float>(first)};
  };
  std::array<float, 4> ray{};
  Place front = place(scalars[0]);
  for (std::size_t k = 1; k <= slabs; ++k) {
    const Place back = place(scalars[k * stride]);
    const float* const texel = table.texels + 4 * (back.first * table.size + front.first);
    const float* const next_row = texel + 4 * table.size;
    const float transmittance = 1.0F - ray[3];
    for (std::size_t c = 0; c < 4; ++c) {
      const float at_first = texel[c] + back.weight * (next_row[c] - texel[c]);
      const float at_next = texel[c + 4] + back.weight * (next_row[c + 4] - texel[c + 4]);
      ray[c] += transmittance * (at_first + front.weight * (at_next - at_first));
    }
    front = back;
  }
  return ray;
}

void four_rays_against_scalar(benchmark::State& state) {
  const auto version = static_cast<std::size_t>(state.range(1));
  if (version >= slab_kernel_versions().size()) return state.SkipWithError("this processor has no such version");
  const std::vector<float> scalars = scalars_of(state.range(0) != 0);
  const SlabTable looked_up{table().values.data(), table_size, static_cast<float>(table_size - 1), 0};
  const auto four = [&] {
    std::array<float, 16> rays{};
    slab_kernel_versions()[version]->march_four(looked_up, scalars.data(), slab_count, rays.data());
    return rays[0] + rays[5] + rays[10] + rays[15];
  };
  const auto scalar = [&] {
    float sum = 0;
    for (std::size_t ray = 0; ray < 4; ++ray) sum += march_one(looked_up, scalars.data() + ray, 4, slab_count)[ray];
    return sum;
  };
  if (!(std::abs(four() - scalar()) < 1e-4F)) return state.SkipWithError("the two do not agree");
  run_paired(state, four, scalar);
  const double slabs = 4 * static_cast<double>(slab_count);
  state.counters["subject_nanoseconds_per_slab"] = 1e9 * state.counters["subject_seconds"] / slabs;
  state.counters["peer_nanoseconds_per_slab"] = 1e9 * state.counters["peer_seconds"] / slabs;
}
BENCHMARK(four_rays_against_scalar)
    ->ArgNames({"coherent", "version"})
    ->ArgsProduct({{1, 0}, {0, 1, 2}})
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace raytruth::benchmarks
