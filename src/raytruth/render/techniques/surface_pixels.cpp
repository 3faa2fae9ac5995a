#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/reference/surface_integral.hpp"
#include "raytruth/reference/surroundings_of.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/render/suitable_surfaces.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/render/techniques/shaded_ray.hpp"
#include "raytruth/schemes/surface_march.hpp"
#include "raytruth/shading/point_light.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/tables/lit/isoslab_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

namespace raytruth {

namespace {

/// What a surface sends out where its normal is this one, none where that is zero: white light for its highlight.
Vector3<double> lit_color(const Isosurface& surface, const Vector3<double>& normal, const LitView& view,
                          const SceneShading& shading) {
  const Lighting& lighting = view.lighting();
  const Illumination illumination(lighting);
  const LightModel model(lighting, shading.gooch, SpecularDensity::white);
  const auto cosine = [&normal](const Vector3<double>& direction) { return (normal * direction).sum(); };
  const PointLight light = (normal == 0).all() ? model.without_normal()
                                               : model(illumination.diffuse(cosine(lighting.light)),
                                                       illumination.specular(cosine(lighting.half)));
  return light.matter * surface.color + light.white;
}

/// The signal of a pixel in 106 bits, and where it crosses the surfaces.
template <class Field>
struct PreciseRay {
  PreciseRay(const Field& field, double steepest, const PixelRay& pixel, const std::vector<double>& scalars)
      : signal(field.trace_precisely(pixel.ray, pixel.displacement)) {
    if (pixel.displacement.may_differ_in_all) signal.of_length = std::numeric_limits<double>::infinity();
    scale_lengths(signal, pixel.length_unit);
    hits = surface_hits(signal, scalars, {.steepest = steepest / pixel.length_unit, .are_in_line = false});
  }

  PreciseChain<Field::degree> signal;
  SurfaceHits hits;
};

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
    const PreciseRay<Field> ray(field_, steepest_, pixel, integrate_.scalars());
    const Certified truth = integrate_(ray.signal, ray.hits, tolerance_);
    return {truth.rgba(), truth.radius, truth.status, !ray.hits.unresolved.empty()};
  }

 private:
  const Field& field_;
  double steepest_;
  double tolerance_;
  SurfaceIntegral integrate_;
};

/// Isosurfaces lit where they are crossed, by the normal there. The radius is measured: by how much the light differs
/// where a crossing may lie; behind an unresolved contact it is all light that there can be.
template <class Field>
class LitSurfacePixels {
 public:
  LitSurfacePixels(const Field& field, const Scene& scene)
      : field_(field), scene_(scene), steepest_(steepest_slope(field)), gradient_(gradient_of(scene, field)) {
    for (const Isosurface& surface : scene.isosurfaces) scalars_.push_back(surface.s);
  }

  PixelLight operator()(const PixelRay& pixel) const {
    const PreciseRay<Field> ray(field_, steepest_, pixel, scalars_);
    const LitView view(gradient_, scene_.border, *scene_.shading, pixel);
    const double first_contact =
        ray.hits.unresolved.empty() ? std::numeric_limits<double>::infinity() : ray.hits.unresolved.front().from;
    Rules<double>::vec4 light = Rules<double>::vec4::Zero();
    double radius = 0;
    double doubt = ray.hits.unresolved.empty() ? 0 : 1;
    double brightest = 1;
    for (const SurfaceHit& hit : ray.hits.hits) {
      const Isosurface& surface = scene_.isosurfaces[hit.surface];
      const auto t = static_cast<double>(hit.t);
      const auto color_at = [&](double place) {
        return lit_color(surface, view.normal_at(place), view, *scene_.shading);
      };
      const Vector3<double> color = color_at(t);
      const double spread = std::max((color_at(t - hit.error) - color).abs().maxCoeff(),
                                     (color_at(t + hit.error) - color).abs().maxCoeff());
      Rules<double> rules;
      const double transmittance = 1 - light[3];
      light = rules.over(light, rules.isosurface_slab({color[0], color[1], color[2], surface.opacity}));
      brightest = std::max(brightest, color.maxCoeff());
      radius += transmittance * surface.opacity * spread + rounding * brightest;
      if (t <= first_contact && doubt > 0) doubt = 1 - light[3];
    }
    radius += doubt * brightest;
    return {light, radius, radius <= tolerance_of_lit_rays * brightest ? Status::converged : Status::not_converged,
            !ray.hits.unresolved.empty()};
  }

 private:
  static constexpr double rounding = 0x1p-49;  // of a product, a sum and a colour's cosines

  const Field& field_;
  const Scene& scene_;
  double steepest_;
  PointGradient gradient_;
  std::vector<double> scalars_;
};

/// A scheme's surfaces and the matter between them; with shading, surfaces alone.
template <class Field>
class SurfaceSchemePixels {
 public:
  SurfaceSchemePixels(const Field& field, const Scene& scene)
      : field_(field),
        scene_(scene),
        scheme_(*find_named(catalogue::surface_schemes(), scene.scheme)),
        march_(scene.transfer, scene.emission, scene.isosurfaces) {
    if (scene.shading) gradient_.emplace(gradient_of(scene, field));
  }

  PixelLight operator()(const PixelRay& pixel) {
    field_.trace(pixel.ray, chain_);
    scale_lengths(chain_, pixel.length_unit);
    take_samples(chain_, scene_.step, samples_);
    if (!gradient_) return {march_(scheme_, chain_, samples_, scene_.surface_tolerance).rgba()};
    const LitView view(*gradient_, scene_.border, *scene_.shading, pixel);
    const auto normal_at = [&view](double t) { return view.normal_at(t); };
    const auto color_of = [&](const SampledHit& hit) {
      return lit_color(scene_.isosurfaces[hit.surface], normal_of(scheme_, hit, samples_, normal_at), view,
                       *scene_.shading);
    };
    return {march_(scheme_, chain_, samples_, scene_.surface_tolerance, color_of).rgba()};
  }

 private:
  const Field& field_;
  const Scene& scene_;
  const SurfaceScheme& scheme_;
  SurfaceMarch march_;
  std::optional<PointGradient> gradient_;
  Chain<Field::degree> chain_;
  Samples<double> samples_;
};

/// Slabs of isosurfaces, looked up; with shading lit by a method from the normals at samples.
template <class Field>
class IsoslabPixels {
 public:
  IsoslabPixels(const Field& field, const Scene& scene, std::shared_ptr<const IsoslabTable> table)
      : field_(field), scene_(scene), table_(std::move(table)) {
    if (scene.shading) gradient_.emplace(gradient_of(scene, field));
  }

  PixelLight operator()(const PixelRay& pixel) {
    field_.trace(pixel.ray, chain_);
    scale_lengths(chain_, pixel.length_unit);
    take_samples(chain_, scene_.step, samples_);
    if (!gradient_) return {isoslab_light(*table_, samples_).rgba()};
    const LitView view(*gradient_, scene_.border, *scene_.shading, pixel);
    const auto light_of = [&](double begin, double end) { return view.slab_light(*scene_.shading, begin, end); };
    return {isoslab_light(*table_, samples_, light_of).rgba()};
  }

 private:
  const Field& field_;
  const Scene& scene_;
  std::shared_ptr<const IsoslabTable> table_;
  std::optional<PointGradient> gradient_;
  Chain<Field::degree> chain_;
  Samples<double> samples_;
};

PixelRendererFactory prepare_reference(const PreparedScene& prepared) {
  return std::visit(
      [&scene = prepared.scene](const auto& field) -> PixelRendererFactory {
        if (scene.shading) return [&field, &scene] { return LitSurfacePixels(field, scene); };
        return [&field, &scene] { return SurfacePixels(field, scene); };
      },
      prepared.field);
}

PixelRendererFactory prepare_isoslabs(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto [low, high] = scene.grid.range();
  const auto table = std::make_shared<const IsoslabTable>(
      scene.isosurfaces, *find_named(catalogue::surface_schemes(), scene.scheme)->isoslab, scene.isoslab,
      TableAxes{.size = scene.isoslab.size,
                .low = low,
                .high = low < high ? high : low + 1,  // a constant grid asks for one entry only
                .length = scene.step.value_or(1)});
  return std::visit(
      [&](const auto& field) -> PixelRendererFactory {
        return [&field, &scene, table] { return IsoslabPixels(field, scene, table); };
      },
      prepared.field);
}

PixelRendererFactory prepare_scheme(const PreparedScene& prepared) {
  if (find_named(catalogue::surface_schemes(), prepared.scene.scheme)->isoslab) return prepare_isoslabs(prepared);
  return std::visit(
      [&scene = prepared.scene](const auto& field) -> PixelRendererFactory {
        return [&field, &scene] { return SurfaceSchemePixels(field, scene); };
      },
      prepared.field);
}

void refuse(const PreparedScene& prepared) { refuse_unsuitable_surfaces(prepared.scene); }

bool is_clear(const Scene& scene) {
  const auto [low, high] = scene.grid.range();
  return ClearScalars(scene.transfer, scene.emission).contain(low, high);
}

void refuse_unlit(const SceneShading& shading, bool is_isoslab) {
  if (shading.virtual_normals != VirtualNormals::own)
    throw InputError("found virtual normals on isosurfaces; own is allowed");
  if (!is_isoslab && shading.method != nullptr)
    throw InputError(
        fmt::format("found the shading {} of slabs on isosurfaces; pointwise is allowed", shading.method->name));
  if (is_isoslab && (shading.method == nullptr || !MomentTable::takes(*shading.method)))
    throw InputError(fmt::format(
        "found the shading {} on isoslabs; methods whose light depends on the normals at both ends of a slab only, as "
        "linear_intensity, are allowed",
        shading.method == nullptr ? "pointwise" : shading.method->name));
}

}  // namespace

void refuse_unsuitable_surfaces(const Scene& scene) {
  if (scene.isosurfaces.empty())
    throw InputError(
        fmt::format("found the scheme {} without isosurfaces; a transfer function with them is allowed", scene.scheme));
  if (scene.scheme == "threshold" && !(scene.surface_tolerance > 0))
    throw InputError("found the scheme threshold without a tolerance; a positive surface_tolerance is allowed");
  const SurfaceScheme* const scheme = find_named(catalogue::surface_schemes(), scene.scheme);
  const bool is_isoslab = scheme != nullptr && scheme->isoslab.has_value();
  if (is_isoslab && !is_clear(scene))
    throw InputError("found isoslabs in matter; a transfer function of isosurfaces alone, without points, is allowed");
  if (is_isoslab && *scheme->isoslab == IsoslabDensity::per_length && !scene.step)
    throw InputError("found isoslabs per length without a step; one is allowed: it is the length of the table's slabs");
  if (!scene.shading) return;
  refuse_unlit(*scene.shading, is_isoslab);
  if (!is_clear(scene))
    throw InputError(
        "found light on matter beside isosurfaces; a transfer function of isosurfaces alone, without points, or no "
        "shading is allowed");
}

extern const Technique surface_pixels;
const Technique surface_pixels{
    .name = "surfaces",
    .summary = "the integral of matter and isosurfaces: certified, or lit and converged",
    .applies = [](const Scene& scene) { return !scene.isosurfaces.empty() && scene.scheme == "reference"; },
    .refuse = refuse,
    .prepare = prepare_reference};

extern const Technique surface_scheme_pixels;
const Technique surface_scheme_pixels{
    .name = "surface_scheme",
    .summary = "isosurfaces where a scheme finds them between samples",
    .applies = [](const Scene& scene) { return find_named(catalogue::surface_schemes(), scene.scheme) != nullptr; },
    .refuse = refuse,
    .prepare = prepare_scheme};

}  // namespace raytruth
