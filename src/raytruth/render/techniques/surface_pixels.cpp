#include "raytruth/core/error.hpp"
#include "raytruth/reference/surface_integral.hpp"
#include "raytruth/reference/surroundings_of.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/render/technique.hpp"

#include <limits>
#include <variant>

namespace raytruth {

namespace {

/// The certified integral of matter and isosurfaces, in 106 bits from the beginning: crossings are looked for
/// everywhere, and nothing is skipped.
template <class Field>
class SurfacePixels {
 public:
  SurfacePixels(const Field& field, const Scene& scene)
      : field_(field),
        steepest_(steepest_slope(field)),
        tolerance_(scene.covers_camera ? tolerance_with_camera : tolerance_of_rays),
        integrate_(scene.transfer, scene.emission, scene.isosurfaces) {}

  PixelLight operator()(const PixelRay& pixel) {
    PreciseChain<Field::degree> signal = field_.trace_precisely(pixel.ray, pixel.displacement);
    if (pixel.displacement.may_differ_in_all) signal.of_length = std::numeric_limits<double>::infinity();
    scale_lengths(signal, pixel.length_unit);
    const SurfaceHits hits =
        surface_hits(signal, integrate_.scalars(), {.steepest = steepest_ / pixel.length_unit, .are_in_line = false});
    const Certified truth = integrate_(signal, hits, tolerance_);
    return {truth.rgba(), truth.radius, truth.status, !hits.unresolved.empty()};
  }

 private:
  const Field& field_;
  double steepest_;
  double tolerance_;
  SurfaceIntegral integrate_;
};

PixelRendererFactory prepare(const PreparedScene& prepared) {
  return std::visit(
      [&prepared](const auto& field) -> PixelRendererFactory {
        return [&field, &prepared] { return SurfacePixels(field, prepared.scene); };
      },
      prepared.field);
}

}  // namespace

extern const Technique surface_pixels;
const Technique surface_pixels{
    .name = "surfaces",
    .summary = "the certified integral of matter and isosurfaces",
    .applies = [](const Scene& scene) { return !scene.isosurfaces.empty(); },
    .refuse =
        [](const PreparedScene& prepared) {
          const Scene& scene = prepared.scene;
          if (scene.scheme != "reference" || scene.shading)
            throw InputError("found isosurfaces with a scheme or with shading; the reference without is allowed");
        },
    .prepare = prepare};

}  // namespace raytruth
