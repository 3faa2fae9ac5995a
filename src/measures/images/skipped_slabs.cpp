#include "measures/images/skipped_slabs.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/schemes/virtual_samples.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/skipping/block_refinement.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr int slabs_per_interval = 4;

class Counter {
 public:
  explicit Counter(const Scene& scene)
      : scene_(scene),
        view_(scene.camera, scene.grid.spacing),
        field_(ray_field(scene.grid, scene.field, scene.border)),
        grid_(std::visit([](const auto& field) -> const Grid& { return field.grid(); }, field_)),
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

  /// Positions in smallest spacings.
  [[nodiscard]] Samples<double> samples_along(const PixelRay& pixel) const {
    Samples<double> samples;
    std::visit(
        [&]<class Field>(const Field& field) {
          Chain<Field::degree> chain;
          field.trace(pixel.ray, chain);
          sample_constant(chain, *scene_.step / pixel.length_unit, samples);
        },
        field_);
    for (auto& position : samples.positions) position = position * pixel.length_unit;
    samples.step = *scene_.step;
    return samples;
  }

  void count(const PixelRay& pixel) {
    const auto direction = unit_direction(pixel.ray.direction);
    const Span inside = clip(grid_.size, scene_.border, pixel.ray.origin, direction);
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
  RayField field_;
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
