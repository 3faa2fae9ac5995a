#pragma once

#include "raytruth/gl/device.hpp"
#include "raytruth/images/image.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/textures/texture.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>

namespace raytruth {

/// What the hand-written renderer draws.
struct TexturedScene {
  Texture volume;    ///< three-dimensional, one channel: scalars in [0, 1]
  Texture transfer;  ///< one-dimensional, four channels: colour and extinction at equally spaced scalars from 0 to 1
  std::array<double, 3> spacing{1, 1, 1};
  Camera camera;
  double step = 1;  ///< distance of samples; as the extinctions' lengths in smallest spacings
};

/// The scene in textures of 32-bit floats, `entries` of them for the transfer function. Throws InputError for fewer
/// than two.
TexturedScene textured_scene(const Grid& grid, const PiecewiseLinear& transfer, std::int64_t entries);

/// The image that a renderer in GLSL makes of the scene: midpoint samples, post-classified, associated colours
/// (hand_written_renderer.frag). It shares no text with the rules and no code with CameraView: a second pair of eyes.
/// Throws MissingError for what is beyond the device.
Image draw_by_hand_written_renderer(GlDevice& device, const TexturedScene& scene);

}  // namespace raytruth
