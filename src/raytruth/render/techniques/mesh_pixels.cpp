#include "raytruth/cells/tetrahedral_field.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/signals/ray_field.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

namespace raytruth {

namespace {

/// The certified integral along rays as the camera rounds them.
PixelLight certified_light(const TetrahedralField& mesh, const PixelRay& pixel, RayIntegral& integrate) {
  const MeshRay ray = mesh.trace(pixel.ray);
  const auto [chain, error] = ray.chain();
  Certified truth = integrate(chain, error);
  if (truth.status == Status::not_converged) {
    const Certified closer = integrate(ray.signal);
    if (closer.radius < truth.radius) truth = closer;
  }
  return {truth.rgba(), truth.radius, truth.status};
}

/// Some of a chain as one that begins at 0.
Chain<3> part_of(const Chain<3>& chain, std::size_t begin, std::size_t end) {
  Chain<3> part;
  const auto start = chain.pieces[begin].start;
  for (std::size_t i = begin; i < end; ++i) {
    part.pieces.push_back(chain.pieces[i]);
    part.pieces.back().start = chain.pieces[i].start - start;
  }
  part.end = chain.end_of(end - 1) - start;
  return part;
}

/// A scheme from cell to cell: samples at the faces and in the middle between them, part by part of the ray.
PixelLight scheme_light(const TetrahedralField& mesh, const PixelRay& pixel, const IntegralScheme& scheme,
                        SchemeIntegral& integrate) {
  const MeshRay ray = mesh.trace(pixel.ray);
  const Chain<3> chain = ray.chain().first;
  Eigen::Array4d light = Eigen::Array4d::Zero();
  Samples<double> samples;
  for (std::size_t i = 0; i < ray.parts.size(); ++i) {
    const std::size_t end = i + 1 < ray.parts.size() ? ray.parts[i + 1].first_piece : chain.pieces.size();
    const Chain<3> part = part_of(chain, ray.parts[i].first_piece, end);
    sample_cells(part, samples);
    const Outcome<> outcome = integrate(scheme, part, samples);
    if (!outcome.refusal.empty()) throw InputError(fmt::format("{}: {}", scheme.name, outcome.refusal));
    light += (1 - light[3]) * outcome.rgba();
  }
  return {light};
}

PixelRendererFactory prepare(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const TetrahedralField& mesh = *scene.mesh;
  if (scene.scheme == "reference")
    return [&scene, &mesh]() -> PixelRenderer {
      return [&mesh, integrate = RayIntegral(scene.transfer, scene.emission)](const PixelRay& pixel) mutable {
        return certified_light(mesh, pixel, integrate);
      };
    };
  const IntegralScheme& scheme = *find_named(catalogue::integral_schemes(), scene.scheme);
  return [&scene, &mesh, &scheme]() -> PixelRenderer {
    return [&mesh, &scheme, integrate = SchemeIntegral(scene.transfer, scene.emission)](const PixelRay& pixel) mutable {
      return scheme_light(mesh, pixel, scheme, integrate);
    };
  };
}

void refuse(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto refuse_if = [](bool is_asked, std::string_view what) {
    if (is_asked)
      throw InputError(fmt::format(
          "{} with a mesh; the scheme reference, and others with samples at the faces of its cells, are allowed",
          what));
  };
  refuse_if(scene.shading.has_value(), "shading");
  refuse_if(scene.table.has_value(), "a table");
  refuse_if(scene.scheme != "reference" && scene.step.has_value(), "a step");
  refuse_if(scene.empty_space.has_value(), "empty_space");
  refuse_if(std::isfinite(scene.opaque), "early_termination");
  refuse_if(!scene.isosurfaces.empty(), "isosurfaces");
  const IntegralScheme* const scheme = find_named(catalogue::integral_schemes(), scene.scheme);
  if (scene.scheme != "reference" && scheme == nullptr)
    throw InputError(fmt::format("scheme {}; one of the listed is allowed", scene.scheme));
}

}  // namespace

extern const Technique mesh_pixels;
const Technique mesh_pixels{.name = "mesh",
                            .summary = "rays through tetrahedra: the certified integral, or a scheme from face to face",
                            .applies = [](const Scene& scene) { return scene.mesh != nullptr; },
                            .refuse = refuse,
                            .prepare = prepare};

}  // namespace raytruth
