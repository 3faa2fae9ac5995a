#pragma once

#include "raytruth/render/camera.hpp"
#include "raytruth/render/pixel_light.hpp"
#include "raytruth/render/scene.hpp"
#include "raytruth/signals/ray_field.hpp"

#include <functional>
#include <span>
#include <string_view>

namespace raytruth {

/// A scene that can be rendered, with what every technique needs of it.
struct PreparedScene {
  /// Throws InputError for cameras that CameraView refuses, and for rays that begin farther than 2^30 voxels away: from
  /// there positions of 53 bits would miss voxels.
  explicit PreparedScene(Scene its_scene);
  ~PreparedScene() = default;
  PreparedScene(const PreparedScene&) = delete;  // the field refers to the scene's grid
  PreparedScene& operator=(const PreparedScene&) = delete;
  PreparedScene(PreparedScene&&) = delete;
  PreparedScene& operator=(PreparedScene&&) = delete;

  Scene scene;
  CameraView view;
  RayField field;
  /// Voxels, where rays pass through the grid: more than a ray is misplaced there by the rounding of its numbers and of
  /// the walk along it, unless `up` is next to parallel to the view.
  double placing_error;
};

/// What a thread renders pixels with.
using PixelRenderer = std::function<PixelLight(const PixelRay&)>;

/// Makes one for every thread.
using PixelRendererFactory = std::function<PixelRenderer()>;

/// A way to make pixels: a row of `techniques()`.
struct Technique {
  std::string_view name;
  std::string_view summary;
  /// Whether the scene is this technique's, none of the rows before having taken it.
  bool (*applies)(const Scene&);
  /// Throws InputError, before anything is computed, for what it cannot do with the scene.
  void (*refuse)(const PreparedScene&);
  /// What all pixels share is made here, once. The scene outlives what is returned.
  PixelRendererFactory (*prepare)(const PreparedScene&);
};

/// All of them; the first that applies renders a scene (render/techniques/techniques.cpp names them).
std::span<const Technique* const> techniques();

}  // namespace raytruth
