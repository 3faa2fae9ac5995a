#include "raytruth/documents/scene_warnings.hpp"

#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/skipping/clear_scalars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace raytruth {

namespace {

bool meets_volume(const Scene& scene) {
  const CameraView view(scene.camera, scene.grid.spacing);
  const auto [width, height] = scene.camera.size;
  // From the middle outwards would be no faster: one hit is enough, and a camera that misses is looked at to its end.
  for (std::int64_t row = 0; row < height; ++row)
    for (std::int64_t column = 0; column < width; ++column) {
      const Ray ray = view(column, row).ray;
      const Span inside = clip(scene.grid.size, scene.border, ray.origin, ray.direction);
      if (inside.begin < inside.end) return true;
    }
  return false;
}

}  // namespace

void warn_of_what_is_not_seen(const Scene& scene, std::vector<std::string>& warnings) {
  if (!meets_volume(scene)) {
    const Grid& grid = scene.grid;
    const auto side = [&grid, margin = margin_of(scene.border)](std::size_t axis) {
      return fmt::format("{} to {}", 0.0 - margin * grid.spacing[axis],
                         (static_cast<double>(grid.size[axis] - 1) + margin) * grid.spacing[axis]);
    };
    warnings.push_back(fmt::format(
        "no ray of the camera meets the volume, which lies from x = {}, y = {}, z = {} in world coordinates; a scene "
        "without \"camera\" gets one that fits",
        side(0), side(1), side(2)));
    if (has_no_extent(grid, scene.border)) warnings.emplace_back(why_no_extent);
  }
  const auto [low, high] = scene.grid.range();
  if (!scene.isosurfaces.empty()) {
    const auto is_met = [low = low, high = high](const Isosurface& surface) {
      return low < surface.s && surface.s < high;
    };
    if (std::any_of(scene.isosurfaces.begin(), scene.isosurfaces.end(), is_met)) return;
    warnings.push_back(
        fmt::format("no isosurface is crossed: the volume's values are {} to {}, the isosurfaces' {} to {}", low, high,
                    scene.isosurfaces.front().s, scene.isosurfaces.back().s));
    if (scene.transfer.points().size() == 1) return;
  }
  const auto& points = scene.transfer.points();
  const double first = points.front().s;
  const double last = points.back().s;
  const std::string ranges =
      fmt::format("the volume's values are {} to {}, the transfer function's points {} to {}", low, high, first, last);
  if (ClearScalars(scene.transfer, scene.emission).contain(low, high)) {
    warnings.push_back("the transfer function is clear at every value of the volume, so the image is black: " + ranges);
    return;
  }
  // A tenth is little for points made for such data, and much for those of another unit.
  constexpr double hardly = 0.1;
  const double shared = std::min(high, last) - std::max(low, first);
  if (first < last && low < high && shared < hardly * std::max(high - low, last - first))
    warnings.push_back("the transfer function hardly meets the volume: " + ranges);
}

}  // namespace raytruth
