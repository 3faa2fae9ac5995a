#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/render/techniques/shaded_ray.hpp"
#include "raytruth/render/techniques/shaded_table.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/volume/gradient.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace raytruth {
namespace {

Lighting lighting_with(std::string_view highlight, Negative negative) {
  return {.light = Vector3<double>(-0.48, 0.64, 0.6),
          .ambient = 0.1,
          .diffuse = 0.8,
          .specular = 0.5,
          .shininess = 12,
          .highlight = find_named(catalogue::highlights(), highlight),
          .negative = negative};
}

/// Rays through all of a noisy volume with unequal spacings.
Scene scene_of(const std::string& scheme, const SceneShading& shading) {
  Grid grid = random_field(14, 1.5, 3);
  grid.spacing = {1, 1.5, 1.25};
  return {.grid = std::move(grid),
          .transfer =
              PiecewiseLinear({{0.4, {0, {0.2, 0.3, 0.9}}}, {0.6, {0.4, {0.9, 0.6, 0.2}}}, {0.8, {1.5, {1, 1, 1}}}}),
          .camera = {.eye = {50, 40, 60},
                     .target = {6.5, 9.75, 8.125},
                     .up = {0, 1, 0},
                     .projection = Perspective{18},
                     .size = {7, 5}},
          .scheme = scheme,
          .step = {},
          .shading = shading};
}

Chain<3> chain_of(const Scene& scene, const PixelRay& pixel) {
  Chain<3> chain;
  trace_trilinear(scene.grid, pixel.ray, chain);
  for (auto& piece : chain.pieces) {
    piece.start = piece.start * pixel.length_unit;
    piece.length *= pixel.length_unit;
  }
  chain.end = chain.end * pixel.length_unit;
  return chain;
}

double largest_difference(const Image& a, const Image& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, (a.pixels[i] - b.pixels[i]).abs().maxCoeff());
  return largest;
}

Image image_of(Scene scene) { return Renderer(std::move(scene)).render().image; }

TEST(ShadedRenderer, ReferenceIsWithinItsRadiusOfCertifiedCells) {
  const std::array lightings{lighting_with("lobe", Negative::clamp), lighting_with("cone", Negative::mirror),
                             lighting_with("lobe", Negative::none)};
  for (const Emission emission : {Emission::associated, Emission::plain})
    for (const Lighting& lighting : lightings) {
      Scene scene = scene_of("reference", {.lighting = lighting});
      scene.emission = emission;
      scene.camera.size = {3, 2};
      scene.camera.projection = Perspective{6};
      const CameraView view(scene.camera, scene.grid.spacing);
      const Rendering rendering = Renderer(scene).render();
      EXPECT_FALSE(rendering.is_certified);
      EXPECT_EQ(rendering.not_converged, 0);
      for (std::int64_t pixel = 0; pixel < 6; ++pixel) {
        const PixelRay ray = view(pixel % 3, pixel / 3);
        const LitView lit(PointGradient(scene.grid), scene.border, *scene.shading, ray);
        const Chain<3> chain = chain_of(scene, ray);
        Eigen::Array4d truth = Eigen::Array4d::Zero();
        double radius = 0;
        for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
          const auto& piece = chain.pieces[i];
          const auto normals =
              lit.normals_along(static_cast<double>(piece.start), static_cast<double>(chain.end_of(i)));
          const CertifiedRadiance cell =
              gradient_reference(piece.polynomial, piece.length, normals, scene.transfer, emission, lit.lighting());
          const double transmittance = 1 - truth[3];
          truth.head<3>() += transmittance * cell.color();
          truth[3] += transmittance * cell.opacity;
          radius += 4 * cell.radius;
        }
        ASSERT_LT(radius, 1e-10);
        EXPECT_GT(truth[3], 0.1);
        const auto index = static_cast<std::size_t>(pixel);
        // Rounding: some hundred panels of sums near 1, and the positions of cells, 2^-52 of 100 voxels.
        EXPECT_LT((rendering.image.pixels[index] - truth).abs().maxCoeff(), rendering.radii[index] + radius + 1e-12);
        EXPECT_LT(rendering.radii[index], 1e-8);
      }
    }
}

TEST(ShadedRenderer, ReferenceIsTheLimitOfPlainSums) {
  // Gradients read point by point, as any renderer would, at the midpoints of very small steps.
  const Scene scene = scene_of("reference", {.lighting = lighting_with("lobe", Negative::clamp)});
  const Rendering rendering = Renderer(scene).render();
  const CameraView view(scene.camera, scene.grid.spacing);
  const GradientFilter& filter = catalogue::gradient_filters().front();
  for (const std::int64_t pixel : {8, 17, 25}) {
    const PixelRay ray = view(pixel % 7, pixel / 7);
    const LitView lit(PointGradient(scene.grid), scene.border, *scene.shading, ray);
    const Illumination illumination(lit.lighting());
    const Chain<3> chain = chain_of(scene, ray);
    const double entry =
        static_cast<double>(clip(scene.grid.size, scene.border, ray.ray.origin, ray.ray.direction).begin);
    constexpr int steps = 100000;
    const double width = chain.length() / steps;
    Eigen::Array4d sum = Eigen::Array4d::Zero();
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * width;
      std::array<double, 3> place{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] = ray.ray.origin[axis] + (entry + t / ray.length_unit) * ray.ray.direction[axis];
      const Vector3<double> gradient = gradient_at(scene.grid, filter, place).raw / Vector3<double>(1, 1.5, 1.25);
      const Vector3<double> normal = -gradient / gradient.matrix().norm();
      const Optics optics = scene.transfer.at(chain.value(t));
      const double opacity = -std::expm1(-optics.extinction * width);
      const double diffuse = illumination.diffuse((normal * lit.lighting().light).sum());
      const double specular = illumination.specular((normal * lit.lighting().half).sum());
      const Vector3<double> light = (0.1 + 0.8 * diffuse) * optics.color + 0.5 * specular;
      Eigen::Array4d slab;
      slab << opacity * light, opacity;
      sum += (1 - sum[3]) * slab;
    }
    // Midpoints of steps of 3e-4 voxels: errors of their square times derivatives of some tens.
    EXPECT_LT((rendering.image.pixels[static_cast<std::size_t>(pixel)] - sum).abs().maxCoeff(), 1e-5);
  }
}

TEST(ShadedRenderer, EverySchemeThatCanBeLitTendsToTheReference) {
  const SceneShading shading{.lighting = lighting_with("lobe", Negative::clamp)};
  const Image truth = image_of(scene_of("reference", shading));
  EXPECT_EQ(largest_difference(image_of(scene_of("cell_cubic", shading)), truth), 0);
  for (const std::string scheme : {"riemann_mid", "trapezoid", "simpson", "sampled_virtual_catmull_rom_3", "order1",
                                   "order2", "virtual_catmull_rom", "virtual_linear_3"}) {
    Scene scene = scene_of(scheme, shading);
    scene.step = 0.2;
    const double coarse = largest_difference(image_of(scene), truth);
    scene.step = 0.05;
    // Kinks at the borders of cells leave the second order, and virtual samples held by a step the first one.
    EXPECT_LT(largest_difference(image_of(scene), truth), coarse / 2) << scheme;
    EXPECT_LT(coarse, 0.05) << scheme;
  }
}

TEST(ShadedRenderer, MethodsTendToTheReferenceWithTheirSamples) {
  for (const std::string_view name :
       {"mean_gradient", "linear_gradient", "linear_intensity", "minimax_arc", "normalized_linear", "quadratic_arc"}) {
    SceneShading shading{.method = find_named(catalogue::shadings(), name),
                         .lighting = lighting_with("lobe", Negative::clamp)};
    const Image truth = image_of(scene_of("reference", {.lighting = shading.lighting}));
    Scene scene = scene_of("cell_cubic", shading);
    scene.step = 0.2;
    const double coarse = largest_difference(image_of(scene), truth);
    scene.step = 0.05;
    // It converges by second order where normals turn smoothly; they turn by up to 180 degrees where the gradient
    // nearly vanishes.
    EXPECT_LT(largest_difference(image_of(scene), truth), coarse / 2) << name;
  }
}

TEST(ShadedRenderer, TablesTendToTheLitScheme) {
  for (const std::string_view name : {"linear_intensity", "quadratic_arc_fades_maximum"})
    for (const std::string builder : {"exact", "subrange_means"}) {
      const SceneShading shading{.method = find_named(catalogue::shadings(), name),
                                 .lighting = lighting_with("cone", Negative::clamp)};
      Scene scene = scene_of("order1", shading);
      scene.step = 0.5;
      const Image truth = image_of(scene);
      scene.table = SceneTable{.builder = builder, .size = 32, .format = table_formats[0]};
      const double coarse = largest_difference(image_of(scene), truth);
      scene.table->size = 128;
      // Bilinear tables converge with n^-2 away from kinks. Their light is exact for these methods.
      EXPECT_LT(largest_difference(image_of(scene), truth), coarse / 4) << name << " " << builder;
      EXPECT_LT(coarse, 0.02) << name << " " << builder;
    }
}

TEST(ShadedRenderer, GoochIsLinearInTheCosine) {
  // Cool where the cosine is 1, warm where it is -1: with the light turned round they change places.
  const Gooch gooch;
  SceneShading shading{.lighting = lighting_with("lobe", Negative::clamp), .gooch = gooch};
  const Image there = image_of(scene_of("reference", shading));
  shading.lighting.light = -shading.lighting.light;
  std::swap(shading.gooch->cool, shading.gooch->warm);
  std::swap(shading.gooch->cool_share, shading.gooch->warm_share);
  EXPECT_LT(largest_difference(image_of(scene_of("reference", shading)), there), 1e-8);
  // Where both tones are one there is no direction: b + a C, with C the unlit colour and b the tone times the opacity.
  shading.gooch = Gooch{.cool = {0.1, 0.2, 0.3}, .warm = {0.1, 0.2, 0.3}, .cool_share = 0.5, .warm_share = 0.5};
  const Image lit = image_of(scene_of("reference", shading));
  Scene unlit = scene_of("reference", shading);
  unlit.shading.reset();
  const Image plain = image_of(unlit);
  for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
    const Vector3<double> expected =
        0.5 * plain.pixels[i].head<3>() + plain.pixels[i][3] * Vector3<double>(0.1, 0.2, 0.3);
    EXPECT_LT((lit.pixels[i].head<3>() - expected).abs().maxCoeff(), 1e-8);
  }
}

/// Samples with virtual ones between, whose normals are made in this way.
Scene virtual_scene(VirtualNormals normals, double step) {
  Scene scene = scene_of("sampled_virtual_catmull_rom_3",
                         {.lighting = lighting_with("lobe", Negative::clamp), .virtual_normals = normals});
  scene.step = step;
  return scene;
}

TEST(ShadedRenderer, CurvesThroughGradientsAreTheirOwnWhereThoseAreLinear) {
  // A quadratic has linear gradients, central differences too, but at the border, far from where it is seen.
  const auto quadratic = [](VirtualNormals normals) {
    Scene scene = virtual_scene(normals, 0.7);
    scene.grid = {.size = {12, 12, 12}, .spacing = {1, 1.5, 1.25}, .values = {}};
    for (int k = 0; k < 12; ++k)
      for (int j = 0; j < 12; ++j)
        for (int i = 0; i < 12; ++i)
          scene.grid.values.push_back(1 - (std::pow(i - 5.4, 2) + std::pow(j - 5.6, 2) + std::pow(k - 5.7, 2)) / 12);
    scene.camera.target = {5.5, 8.25, 6.875};
    return image_of(scene);
  };
  const Image own = quadratic(VirtualNormals::own);
  EXPECT_GT(own.pixels[17][3], 0.5);
  EXPECT_LT(largest_difference(quadratic(VirtualNormals::catmull_rom), own), 1e-12);
  EXPECT_LT(largest_difference(quadratic(VirtualNormals::linear), own), 1e-12);
  // Unit normals turn on circles: their lines and cubics are others, the cubic a closer one.
  const double cubic = largest_difference(quadratic(VirtualNormals::catmull_rom_unit), own);
  const double linear = largest_difference(quadratic(VirtualNormals::linear_unit), own);
  EXPECT_GT(cubic, 1e-6);
  EXPECT_GT(linear, 1.5 * cubic);
}

TEST(ShadedRenderer, CurvesThroughGradientsTendToTheirOwn) {
  for (const VirtualNormals normals : {VirtualNormals::catmull_rom, VirtualNormals::catmull_rom_unit,
                                       VirtualNormals::linear, VirtualNormals::linear_unit}) {
    const auto error = [normals](double step) {
      return largest_difference(image_of(virtual_scene(normals, step)),
                                image_of(virtual_scene(VirtualNormals::own, step)));
    };
    const double coarse = error(0.4);
    EXPECT_GT(coarse, 1e-5);
    // Second order in the kinks at cells' borders, which take a share of all intervals that falls with the step.
    EXPECT_LT(error(0.1), coarse / 4);
  }
}

TEST(ShadedRenderer, GradientsOfTheReconstructionAreRefusedWhereEveryPointHasOne) {
  for (const std::string scheme : {"reference", "cell_cubic", "order1", "riemann_mid"}) {
    Scene scene =
        scene_of(scheme, {.lighting = lighting_with("lobe", Negative::clamp), .gradient = GradientKind::differences});
    scene.step = 0.5;
    if (scheme == "riemann_mid")
      EXPECT_NO_THROW(Renderer{scene});
    else
      EXPECT_THROW(Renderer{scene}, InputError) << scheme;
  }
  Scene scene = virtual_scene(VirtualNormals::catmull_rom, 0.5);
  EXPECT_NO_THROW(Renderer{scene});
  scene.scheme = "riemann_mid";
  EXPECT_THROW(Renderer{scene}, InputError);
}

TEST(ShadedRenderer, WhatItRefuses) {
  const auto lit_by = [](const char* method) {  // null: pointwise
    SceneShading shading{.lighting = lighting_with("lobe", Negative::clamp)};
    if (method != nullptr) shading.method = find_named(catalogue::shadings(), method);
    return shading;
  };
  for (const auto& [scheme, method] : {std::pair{"reference", "quadratic_arc"},
                                       {"trapezoid", "quadratic_arc"},
                                       {"no_scheme", nullptr},
                                       {"order1_no_attenuation", nullptr},
                                       {"cell_adaptive", nullptr},
                                       {"virtual_catmull_rom", nullptr}})
    EXPECT_THROW(Renderer{scene_of(scheme, lit_by(method))}, InputError) << scheme;
  Scene scene = scene_of("order1", lit_by(nullptr));
  scene.table = SceneTable{.size = 16};
  EXPECT_THROW(Renderer{scene}, InputError);
  scene.shading = lit_by("quadratic_arc");
  EXPECT_NO_THROW(Renderer{scene});
  scene.table->builder = "brute_force";
  EXPECT_THROW(Renderer{scene}, InputError);
  scene.table = SceneTable{.size = MomentTable::largest_size + 1};
  EXPECT_THROW(Renderer{scene}, InputError);
  EXPECT_THROW(Renderer{scene_of("order1", lit_by("quadratic_arc_fades"))}, InputError);  // made for cones
}

}  // namespace
}  // namespace raytruth
