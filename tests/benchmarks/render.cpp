// Images of 512 x 512 pixels of a grid of 256^3 voxels at step 1: by a first-order table in binary32, by the exact
// cubic of every cell, and certified. Preparation (tables, copies of voxels) is not timed.

#include "paired.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/trilinear_value.hpp"

#include <tbb/parallel_for.h>

#include <cstdint>
#include <string>

namespace raytruth {
namespace {

constexpr std::int64_t image_side = 512;

/// Smooth noise: half of it clear, the rest a thin mist. Interpolated between 64^3 voxels: a Gaussian four times as
/// wide would take longer than all images.
const Grid& mist() {
  static const Grid grid = [] {
    constexpr std::int64_t coarse = 64;
    const Grid noise = random_field(coarse, 1.5, 1);
    Grid result{.size = {4 * coarse, 4 * coarse, 4 * coarse}, .values = {}};
    result.values.resize(static_cast<std::size_t>(64 * coarse * coarse * coarse));
    tbb::parallel_for(std::int64_t{0}, 4 * coarse, [&](std::int64_t k) {
      for (std::int64_t j = 0; j < 4 * coarse; ++j)
        for (std::int64_t i = 0; i < 4 * coarse; ++i)
          result.values[result.index(i, j, k)] = trilinear_value<double>(
              noise, {static_cast<double>(i) / 4, static_cast<double>(j) / 4, static_cast<double>(k) / 4});
    });
    return result;
  }();
  return grid;
}

Scene scene_of(const std::string& scheme, bool skips) {
  constexpr double middle = 127.5;
  Scene scene{.grid = mist(),
              .transfer = PiecewiseLinear(
                  {{0.5, {0, {0.2, 0.3, 0.9}}}, {0.6, {0.05, {0.9, 0.6, 0.2}}}, {0.8, {0.2, {1, 1, 1}}}}),
              .camera = {.eye = {middle + 300, middle + 200, middle + 400},
                         .target = {middle, middle, middle},
                         .up = {0, 1, 0},
                         .projection = Perspective{30},
                         .size = {image_side, image_side}},
              .scheme = scheme,
              .step = 1};
  if (skips) scene.empty_space = EmptySpace{};
  if (scheme == "order1") scene.table = SceneTable{};
  return scene;
}

/// Where the time goes, by a profile of one image.
std::string bounded_by(const std::string& scheme) {
  if (scheme == "reference") return "two fifths rounding bounds in 106 bits, a quarter the walk in 106 bits";
  if (scheme == "cell_cubic")
    return "two fifths the walk and cubics, a fifth intervals, a fifth integrals, a sixth crossings";
  return "reads of voxels and table";
}

void images(benchmark::State& state, const std::string& scheme, bool skips) {
  const Renderer subject(scene_of(scheme, skips));
  const Renderer table(scene_of("order1", skips && scheme != "order1"));
  benchmarks::run_paired(
      state, [&] { return subject.render().image.pixels.size(); }, [&] { return table.render().image.pixels.size(); });
  state.counters["times_the_peer"] = state.counters["subject_seconds"] / state.counters["peer_seconds"];
  state.counters["nanoseconds_per_pixel"] = 1e9 * state.counters["subject_seconds"] / (image_side * image_side);
  state.SetLabel("bound by: " + bounded_by(scheme));
}

BENCHMARK_CAPTURE(images, table_skipping_against_table, "order1", true)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(images, cell_cubic_against_table, "cell_cubic", false)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(images, cell_cubic_against_table_skipping, "cell_cubic", true)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(images, certified_against_table, "reference", false)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace raytruth
