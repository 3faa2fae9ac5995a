#include "raytruth/render/technique.hpp"
#include "raytruth/render/techniques/shaded_ray.hpp"
#include "raytruth/render/techniques/skipped_space.hpp"
#include "raytruth/render/techniques/suitable_scheme.hpp"

#include <memory>

namespace raytruth {

namespace {

/// A scheme's lit rays.
PixelRendererFactory prepare_scheme(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  return std::visit(
      [&]<class Field>(const Field& field) -> PixelRendererFactory {
        return [&field, &scene, gradient = gradient_of(scene, field),
                blocks = asked_blocks(scene, field)]() -> PixelRenderer {
          return [&field, &scene, blocks, parts_of = PartsOfRay(field.grid().size, field.border(), blocks.get()),
                  chain = Chain<Field::degree>(), samples = Samples<double>(),
                  shaded = ShadedRay<Field::degree>(scene, gradient)](const PixelRay& pixel) mutable -> PixelLight {
            const auto parts = parts_of(pixel.ray, pixel.length_unit);
            if (parts && parts->empty()) return {};
            field.trace(pixel.ray, chain);
            scale_lengths(chain, pixel.length_unit);
            take_samples(chain, scene.step, samples);
            return shaded(pixel, chain, samples, {.occupied = parts, .opaque = scene.opaque});
          };
        };
      },
      prepared.field);
}

/// The lit truth: as a scheme's rays, but whatever is skipped is clear for certain, and rays never end early.
PixelRendererFactory prepare_reference(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  return std::visit(
      [&]<class Field>(const Field& field) -> PixelRendererFactory {
        const auto blocks = std::make_shared<const OccupiedBlocks>(
            certain_blocks(field, ClearScalars(scene.transfer, scene.emission), prepared.placing_error));
        return [&field, &scene, gradient = gradient_of(scene, field), blocks]() -> PixelRenderer {
          return [&field, blocks, parts_of = PartsOfRay(field.grid().size, field.border(), blocks.get()),
                  chain = Chain<Field::degree>(),
                  shaded = ShadedRay<Field::degree>(scene, gradient)](const PixelRay& pixel) mutable -> PixelLight {
            if (parts_of(pixel.ray)->empty()) return {};
            field.trace(pixel.ray, chain);
            scale_lengths(chain, pixel.length_unit);
            return shaded(pixel, chain, {}, {});
          };
        };
      },
      prepared.field);
}

}  // namespace

extern const Technique shaded_reference_pixels;
const Technique shaded_reference_pixels{
    .name = "shaded_reference",
    .summary = "the lit truth: converged, its radius an estimate",
    .applies = [](const Scene& scene) { return scene.scheme == "reference" && scene.shading; },
    .refuse = [](const PreparedScene& prepared) { refuse_unlit(prepared.scene); },
    .prepare = prepare_reference};

extern const Technique shaded_pixels;
const Technique shaded_pixels{.name = "shaded_scheme",
                              .summary = "a scheme's rays, lit",
                              .applies = [](const Scene& scene) { return scene.shading.has_value(); },
                              .refuse =
                                  [](const PreparedScene& prepared) {
                                    refuse_unlit(prepared.scene);
                                    refuse_unsuitable_scheme(prepared);
                                  },
                              .prepare = prepare_scheme};

}  // namespace raytruth
