#include "raytruth/render/renderer.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/render/camera_rounding.hpp"
#include "raytruth/render/technique.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

namespace raytruth {

namespace {

constexpr std::int64_t tile_side = 16;
constexpr double farthest = 0x1p30;  // voxels

void refuse_far_cameras(const Scene& scene, const CameraView& view) {
  const auto [width, height] = scene.camera.size;
  for (const std::int64_t column : {std::int64_t{0}, width - 1})
    for (const std::int64_t row : {std::int64_t{0}, height - 1})
      for (const double x : view(column, row).ray.origin)
        if (!(std::abs(x) <= farthest))
          throw InputError(fmt::format("a ray from voxel coordinate {}; magnitudes up to 2^30 are allowed", x));
}

/// Some units in the last place of the way from where rays begin to the far end of the grid.
double placing_error_of(const Scene& scene, const CameraView& view) {
  const auto [width, height] = scene.camera.size;
  double farthest = 0;
  for (const std::int64_t column : {std::int64_t{0}, width - 1})
    for (const std::int64_t row : {std::int64_t{0}, height - 1}) {
      const auto& [x, y, z] = view(column, row).ray.origin;
      farthest = std::max(farthest, std::abs(x) + std::abs(y) + std::abs(z));
    }
  const auto& [x, y, z] = scene.grid.size;
  return 0x1p-46 * (farthest + static_cast<double>(x + y + z));
}

/// The diagonal of the grid, in smallest spacings.
double diagonal(const Grid& grid) {
  const auto& [x, y, z] = grid.spacing;
  return std::hypot(x * static_cast<double>(grid.size[0]), y * static_cast<double>(grid.size[1]),
                    z * static_cast<double>(grid.size[2])) /
         std::min({x, y, z});
}

/// The first row that applies.
const Technique& technique_of(const Scene& scene) {
  const auto rows = techniques();
  return **std::find_if(rows.begin(), rows.end(), [&scene](const Technique* row) { return row->applies(scene); });
}

PixelRendererFactory factory_of(const PreparedScene& prepared) {
  const Technique& technique = technique_of(prepared.scene);
  technique.refuse(prepared);
  return technique.prepare(prepared);
}

}  // namespace

PreparedScene::PreparedScene(Scene its_scene)
    : scene(std::move(its_scene)),
      view(scene.camera, scene.grid.spacing),
      field(ray_field(scene.grid, scene.field, scene.border)),
      placing_error(placing_error_of(scene, view)) {
  refuse_far_cameras(scene, view);
  // A longer step makes the same samples, both ends of the ray, but numbers that nobody can calculate with.
  if (scene.step && !scene.mesh) scene.step = std::min(*scene.step, 2 * diagonal(scene.grid));
}

struct Renderer::Parts {
  explicit Parts(Scene its_scene) : prepared(std::move(its_scene)), make_renderer(factory_of(prepared)) {
    const Scene& scene = prepared.scene;
    const bool is_straight = !scene.mesh && !scene.deformation;
    if (is_straight && scene.covers_camera && scene.scheme == "reference" && !scene.shading)
      camera_rounding.emplace(scene.camera, scene.grid.spacing, scene.grid.size, scene.border);
  }

  [[nodiscard]] PixelRay ray(std::int64_t column, std::int64_t row) const {
    PixelRay result = prepared.view(column, row);
    if (camera_rounding) result.displacement = (*camera_rounding)(column, row, result);
    return result;
  }

  PreparedScene prepared;
  PixelRendererFactory make_renderer;
  std::optional<CameraRounding> camera_rounding;
};

Renderer::Renderer(Scene scene) : parts_(std::make_unique<Parts>(std::move(scene))) {}
Renderer::~Renderer() = default;

Rendering Renderer::render(const std::function<void(std::size_t, std::size_t)>& progress) const {
  const auto [width, height] = parts_->prepared.scene.camera.size;
  const bool has_radii = parts_->prepared.scene.scheme == "reference";
  Rendering result{.image = Image(parts_->prepared.scene.camera.size),
                   .is_certified = has_radii && !parts_->prepared.scene.shading.has_value()};
  if (has_radii) {
    result.radii.resize(result.image.pixels.size());
    result.covers_camera = parts_->camera_rounding.has_value();
    result.tolerance = !result.is_certified                 ? tolerance_of_lit_rays
                       : parts_->prepared.scene.deformation ? tolerance_of_deformed_rays
                       : parts_->camera_rounding            ? tolerance_with_camera
                                                            : tolerance_of_rays;
  }
  const std::int64_t columns = (width + tile_side - 1) / tile_side;
  const std::int64_t tiles = columns * ((height + tile_side - 1) / tile_side);

  tbb::enumerable_thread_specific<PixelRenderer> renderers(parts_->make_renderer);
  std::atomic<std::int64_t> not_converged = 0;
  std::atomic<std::int64_t> unresolved = 0;
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  tbb::parallel_for(std::int64_t{0}, tiles, [&](std::int64_t tile) {
    PixelRenderer& light_of_pixel = renderers.local();
    const std::int64_t top = tile / columns * tile_side;
    const std::int64_t left = tile % columns * tile_side;
    for (std::int64_t row = top; row < std::min(top + tile_side, height); ++row)
      for (std::int64_t column = left; column < std::min(left + tile_side, width); ++column) {
        const PixelLight pixel = light_of_pixel(parts_->ray(column, row));
        result.image.at(column, row) = pixel.light;
        if (has_radii) result.radii[static_cast<std::size_t>(row * width + column)] = pixel.radius;
        if (pixel.status != Status::converged) ++not_converged;
        if (pixel.has_unresolved_contact) ++unresolved;
      }
    ++done;
    if (!progress) return;
    if (const std::unique_lock lock(telling, std::try_to_lock); lock) progress(done, static_cast<std::size_t>(tiles));
  });
  result.not_converged = not_converged;
  if (!parts_->prepared.scene.isosurfaces.empty()) result.unresolved = unresolved;
  return result;
}

std::vector<PixelLight> Renderer::light_of(std::span<const PixelRay> rays) const {
  std::vector<PixelLight> light(rays.size());
  tbb::enumerable_thread_specific<PixelRenderer> renderers(parts_->make_renderer);
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) { light[i] = renderers.local()(rays[i]); });
  return light;
}

Scene Renderer::take_scene() && {
  Scene scene = std::move(parts_->prepared.scene);
  parts_.reset();
  return scene;
}

}  // namespace raytruth
