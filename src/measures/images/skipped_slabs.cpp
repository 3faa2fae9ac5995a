#include "measures/images/skipped_slabs.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/schemes/virtual_samples.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/field_kind.hpp"
#include "raytruth/signals/tricubic.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/skipping/block_refinement.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

namespace raytruth {

namespace {

constexpr int slabs_per_interval = 4;

/// The samples of the field along a ray; positions in smallest spacings.
template <int Degree, class Trace>
Samples<double> samples_of(const Trace& trace, double length_unit, double step) {
  Chain<Degree> chain;
  trace(chain);
  Samples<double> samples;
  sample_constant(chain, step / length_unit, samples);
  for (auto& position : samples.positions) position = position * length_unit;
  samples.step = step;
  return samples;
}

class Counter {
 public:
  explicit Counter(const Scene& scene)
      : scene_(scene),
        view_(scene.camera, scene.grid.spacing),
        coefficients_(scene.field == FieldKind::bspline_prefiltered ? bspline_coefficients(scene.grid) : Grid{}),
        grid_(scene.field == FieldKind::bspline_prefiltered ? coefficients_ : scene.grid),
        clear_(scene.transfer, scene.emission),
        blocks_(grid_, clear_, scene.empty_space->block,
                block_refinement(scene.field, scene.step, scene.empty_space->bounds)),
        is_wrong_(static_cast<std::size_t>(blocks_.count()[0] * blocks_.count()[1] * blocks_.count()[2])) {}

  SkippedSlabs operator()() {
    const auto [width, height] = scene_.camera.size;
    tbb::parallel_for(std::int64_t{0}, height, [&, columns = width](std::int64_t row) {
      for (std::int64_t column = 0; column < columns; ++column) count(view_(column, row));
    });
    SkippedSlabs result{.slabs = slabs_, .skipped = skipped_, .wrong = wrong_};
    const auto [x, y, z] = blocks_.count();
    for (std::int64_t k = 0; k < z; ++k)
      for (std::int64_t j = 0; j < y; ++j)
        for (std::int64_t i = 0; i < x; ++i) {
          ++result.blocks;
          if (!blocks_.is_occupied(i, j, k)) ++result.skipped_blocks;
          if (is_wrong_[index(i, j, k)]) ++result.wrong_blocks;
        }
    return result;
  }

 private:
  [[nodiscard]] std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * blocks_.count()[1] + j) * blocks_.count()[0] + i);
  }

  [[nodiscard]] Samples<double> samples_along(const PixelRay& pixel) const {
    if (scene_.field == FieldKind::trilinear)
      return samples_of<3>([&](Chain<3>& chain) { trace_trilinear(grid_, pixel.ray, chain); }, pixel.length_unit,
                           *scene_.step);
    const auto kernel = scene_.field == FieldKind::catmull_rom ? CubicKernel::catmull_rom : CubicKernel::bspline;
    return samples_of<9>([&](Chain<9>& chain) { trace_tricubic(grid_, kernel, pixel.ray, chain); }, pixel.length_unit,
                         *scene_.step);
  }

  void count(const PixelRay& pixel) {
    const auto direction = unit_direction(pixel.ray.direction);
    const Span inside = clip(grid_.size, pixel.ray.origin, direction);
    if (!(inside.begin < inside.end)) return;
    const auto begin = static_cast<double>(inside.begin);
    std::array<double, 3> entry{};
    for (std::size_t axis = 0; axis < 3; ++axis) entry[axis] = pixel.ray.origin[axis] + begin * direction[axis];
    std::vector<RayPart> parts;
    blocks_.parts(entry, direction, static_cast<double>(inside.end - inside.begin), parts);
    for (RayPart& part : parts) part = {part.begin * pixel.length_unit, part.end * pixel.length_unit};
    const Omissions omissions{.occupied = parts};

    const Samples<double> samples = samples_along(pixel);
    slabs_ += slabs_per_interval * static_cast<std::int64_t>(samples.interval_count());
    for (std::size_t k = 0; k < samples.interval_count(); ++k) {
      const auto front = static_cast<double>(samples.positions[k]);
      const double width = samples.length_of(k) / slabs_per_interval;
      for (int slab = 0; slab < slabs_per_interval; ++slab) {
        if (!omissions.omit(front + slab * width, front + (slab + 1) * width)) continue;
        ++skipped_;
        const auto& b = VirtualCatmullRom3::interval(Chain<3>(), samples, k, slab).coefficients;
        if (clear_.contain(std::min(b.front(), b.back()), std::max(b.front(), b.back()))) continue;
        ++wrong_;
        mark(entry, direction, (front + (slab + 0.5) * width) / pixel.length_unit);
      }
    }
  }

  /// A skipped slab shows something at that place of the ray.
  void mark(const std::array<double, 3>& entry, const std::array<double, 3>& direction, double t) {
    std::array<std::int64_t, 3> block{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = (entry[axis] + t * direction[axis]) / static_cast<double>(scene_.empty_space->block);
      block[axis] =
          std::clamp(static_cast<std::int64_t>(std::floor(place)), std::int64_t{0}, blocks_.count()[axis] - 1);
    }
    is_wrong_[index(block[0], block[1], block[2])] = true;
  }

  const Scene& scene_;
  CameraView view_;
  Grid coefficients_;
  const Grid& grid_;
  ClearScalars clear_;
  OccupiedBlocks blocks_;
  std::vector<std::atomic<bool>> is_wrong_;
  std::atomic<std::int64_t> slabs_ = 0;
  std::atomic<std::int64_t> skipped_ = 0;
  std::atomic<std::int64_t> wrong_ = 0;
};

}  // namespace

SkippedSlabs count_skipped_slabs(const Scene& scene) {
  if (!scene.step || !scene.empty_space) throw InputError("slabs skipped without a step or without blocks");
  return Counter(scene)();
}

}  // namespace raytruth
