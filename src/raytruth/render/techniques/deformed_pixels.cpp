#include "raytruth/core/error.hpp"
#include "raytruth/deformation/deformed_light.hpp"
#include "raytruth/deformation/deformed_ray.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/render/technique.hpp"

#include <algorithm>
#include <array>
#include <memory>

namespace raytruth {

namespace {

/// The certified integral of a deformed volume, for the pixel's ray in the world as binary64 holds it.
class DeformedPixels {
 public:
  DeformedPixels(const Scene& scene, std::shared_ptr<const DeformedVolume> volume)
      : volume_(std::move(volume)),
        spacing_(scene.grid.spacing),
        shortest_(*std::min_element(spacing_.begin(), spacing_.end())),
        light_(scene.transfer, scene.emission) {}

  PixelLight operator()(const PixelRay& pixel) {
    Ray world;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      world.origin[axis] = pixel.ray.origin[axis] * spacing_[axis];
      world.direction[axis] = pixel.ray.direction[axis] * spacing_[axis];
    }
    volume_->trace(world, signal_);
    scale_lengths(signal_.chain, 1 / shortest_);
    signal_.error.unclaimed /= shortest_;
    const Certified truth = light_(signal_, tolerance_of_deformed_rays);
    return {truth.rgba(), truth.radius, truth.status};
  }

 private:
  std::shared_ptr<const DeformedVolume> volume_;
  std::array<double, 3> spacing_;
  double shortest_;
  DeformedLight light_;
  DeformedSignal signal_;
};

PixelRendererFactory prepare(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto volume = std::make_shared<const DeformedVolume>(
      scene.grid, scene.border, scene.grid.spacing, scene.deformation->lattice, scene.deformation->least_determinant);
  return [&scene, volume] { return DeformedPixels(scene, volume); };
}

}  // namespace

extern const Technique deformed_pixels;
const Technique deformed_pixels{.name = "deformed",
                                .summary = "the certified integral of a deformed volume",
                                .applies = [](const Scene& scene) { return scene.deformation != nullptr; },
                                .refuse =
                                    [](const PreparedScene& prepared) {
                                      const Scene& scene = prepared.scene;
                                      if (scene.scheme != "reference" || scene.shading || !scene.isosurfaces.empty() ||
                                          scene.field != FieldKind::trilinear)
                                        throw InputError(
                                            "found a deformation with a scheme, shading, isosurfaces or tricubic "
                                            "reconstruction; the reference of a "
                                            "trilinear volume without them is allowed");
                                    },
                                .prepare = prepare};

}  // namespace raytruth
