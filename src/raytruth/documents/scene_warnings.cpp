#include "raytruth/documents/scene_warnings.hpp"

#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/skipping/clear_scalars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
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

void warn_of_opacity(const PiecewiseLinear& transfer, std::vector<std::string>& warnings) {
  double largest = 0;
  for (const TransferPoint& point : transfer.points()) largest = std::max(largest, point.optics.extinction);
  if (!transfer.is_linear_in_opacity()) {
    // An extinction has no reason to end at 1 exactly, which is where opacities end.
    if (largest == 1)
      warnings.emplace_back(
          "the largest extinction is exactly 1, as if it were an opacity: extinctions are per smallest spacing; points "
          "of \"opacity\", with \"unit_length\" beside them, state opacities");
    constexpr double opaque_within_a_tenth = 70;  // exp(-7) is left after a tenth of the smallest spacing
    if (largest > opaque_within_a_tenth)
      warnings.push_back(
          fmt::format("an extinction of {} per smallest spacing is opaque within a tenth of it: is it per "
                      "another length?",
                      largest));
    return;
  }
  constexpr double far = 8;
  if (const double unit = transfer.unit_length(); unit > far || unit < 1 / far)
    warnings.push_back(fmt::format(
        "opacities are of a length of {} smallest spacings, far from 1: a unit of length taken for another one makes "
        "everything thinner or denser; \"unit_length\" states it",
        unit));
}

/// Values beyond the transfer function's points have the optics of the outermost one.
void warn_of_clamped_values(const Scene& scene, std::vector<std::string>& warnings) {
  const auto& points = scene.transfer.points();
  const ClearScalars clear(scene.transfer, scene.emission);
  constexpr double few = 0.001;
  const auto& values = scene.grid.values;
  const auto tell = [&](std::string_view side, const TransferPoint& end, auto is_beyond) {
    if (clear.contain(end.s, end.s)) return;
    const double share = static_cast<double>(std::count_if(values.begin(), values.end(), is_beyond)) /
                         static_cast<double>(values.size());
    if (share > few)
      warnings.push_back(
          fmt::format("{:.3g} % of the voxels lie {} the transfer function's {} point, s = {}, and are "
                      "taken as it",
                      100 * share, side, side == "below" ? "first" : "last", end.s));
  };
  tell("below", points.front(), [s = points.front().s](double value) { return value < s; });
  tell("above", points.back(), [s = points.back().s](double value) { return value > s; });
}

void warn_of_few_levels(const Grid& grid, std::vector<std::string>& warnings) {
  constexpr std::size_t few = 32;
  std::set<double> levels;
  for (const double value : grid.values)
    if (levels.insert(value).second && levels.size() > few) return;
  if (levels.size() > 1)
    warnings.push_back(fmt::format("the volume has {} levels only: what looks like bands is its own", levels.size()));
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

void warn_of_conventions(const Scene& scene, std::vector<std::string>& warnings) {
  warn_of_opacity(scene.transfer, warnings);
  warn_of_clamped_values(scene, warnings);
  warn_of_few_levels(scene.grid, warnings);
}

}  // namespace raytruth
