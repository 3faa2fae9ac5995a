#pragma once

#include "raytruth/images/image.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/render/pixel_light.hpp"
#include "raytruth/render/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace raytruth {

// A pixel of `reference` counts as converged if its radius is no larger than this times max(1, largest colour; for
// plain emission times the ray's length), of rounded rays, and of rays as the camera means them, whose places binary64
// cannot hold, and of deformed ones; of lit ones, estimates, if two quadratures differ by no more on any part of the
// ray (LitIntegral).
inline constexpr double tolerance_of_rays = 1e-13;
inline constexpr double tolerance_with_camera = 1e-9;
inline constexpr double tolerance_of_deformed_rays = 1e-9;
inline constexpr double tolerance_of_lit_rays = 1e-10;

/// What a renderer makes of a scene.
struct Rendering {
  Image image;
  /// For `reference`, in every pixel: a proven bound on the error of each channel and of the opacity if `is_certified`,
  /// else the measured one, by how much two quadratures differ (LitIntegral). Empty for other schemes.
  std::vector<double> radii = {};
  bool is_certified = false;
  bool covers_camera = false;      ///< the radii are for the rays that the camera means, not for rounded ones
  double tolerance = 0;            ///< what was asked for
  std::int64_t not_converged = 0;  ///< pixels whose radius is wider than that; it holds
  /// Pixels of which it is not known how often their rays cross an isosurface; none: the scene has none.
  std::optional<std::int64_t> unresolved = {};
};

/// Makes images of a scene: prepares it once, renders on all cores, the same bytes on any number of them.
///
/// Schemes see the exact polynomials along the ray, sampled as the scene says. `reference` is the certified integral
/// for the ray and the length unit of the pixel as rounded to binary64; where `Scene::covers_camera`, its radii cover
/// this rounding too (CameraRounding). With shading it is converged, not certified (ShadedRay). It neither skips space
/// nor ends early. Two schemes without shading have a way of their own through a trilinear grid: `order1` with a table
/// and equal steps, in binary32 (TableMarch); and `cell_cubic` (CellMarch).
class Renderer {
 public:
  /// Throws InputError for what the scene cannot be rendered with, with what is wrong but without a place.
  explicit Renderer(Scene scene);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  Renderer(Renderer&&) = delete;
  Renderer& operator=(Renderer&&) = delete;

  /// Calls `progress(done, of)` after some tiles, by one thread at a time. Throws InputError for too many samples.
  [[nodiscard]] Rendering render(const std::function<void(std::size_t, std::size_t)>& progress = {}) const;

  /// The light of some rays, of any camera's pixels, on all cores; radii are for rounded rays.
  [[nodiscard]] std::vector<PixelLight> light_of(std::span<const PixelRay> rays) const;

  /// The scene, for another renderer; this one is of no more use.
  [[nodiscard]] Scene take_scene() &&;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace raytruth
