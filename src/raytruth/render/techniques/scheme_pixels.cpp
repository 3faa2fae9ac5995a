#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/render/techniques/skipped_space.hpp"
#include "raytruth/render/techniques/suitable_scheme.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/scheme_integral.hpp"

#include <fmt/format.h>

namespace raytruth {

namespace {

/// Any scheme: the exact polynomials along the ray, sampled as the scene says.
PixelRendererFactory prepare(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const IntegralScheme& scheme = *find_named(catalogue::integral_schemes(), scene.scheme);
  return std::visit(
      [&]<class Field>(const Field& field) -> PixelRendererFactory {
        return [&field, &scene, &scheme, blocks = asked_blocks(scene, field)]() -> PixelRenderer {
          return [&field, &scene, &scheme, blocks,
                  parts_of = PartsOfRay(field.grid().size, field.border(), blocks.get()),
                  chain = Chain<Field::degree>(), samples = Samples<double>(),
                  integrate =
                      SchemeIntegral(scene.transfer, scene.emission)](const PixelRay& pixel) mutable -> PixelLight {
            const auto parts = parts_of(pixel.ray, pixel.length_unit);
            if (parts && parts->empty()) return {};
            field.trace(pixel.ray, chain);
            scale_lengths(chain, pixel.length_unit);
            take_samples(chain, scene.step, samples);
            const Outcome<> outcome = integrate(scheme, chain, samples, {.occupied = parts, .opaque = scene.opaque});
            if (!outcome.refusal.empty()) throw InputError(fmt::format("{}: {}", scheme.name, outcome.refusal));
            return {outcome.rgba()};
          };
        };
      },
      prepared.field);
}

}  // namespace

extern const Technique scheme_pixels;
const Technique scheme_pixels{.name = "scheme",
                              .summary = "any scheme on the exact polynomials along the ray",
                              .applies = [](const Scene& /*scene*/) { return true; },
                              .refuse = refuse_unsuitable_scheme,
                              .prepare = prepare};

}  // namespace raytruth
