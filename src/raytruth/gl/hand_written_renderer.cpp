#include "raytruth/gl/hand_written_renderer.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/gl/texts.hpp"
#include "raytruth/gl/texture_look_ups.hpp"

#include <fmt/format.h>

#include <numbers>

namespace raytruth {

namespace {

std::array<float, 3> to_float(const std::array<double, 3>& point) {
  return {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
}

/// The scene's numbers as the shader reads them.
std::map<std::string, GlUniform> uniforms(const TexturedScene& scene) {
  const Camera& camera = scene.camera;
  std::map<std::string, GlUniform> result{
      {"spacing", to_float(scene.spacing)},
      {"eye", to_float(camera.eye)},
      {"look_at", to_float(camera.target)},
      {"up", to_float(camera.up)},
      {"image_size", std::array{static_cast<float>(camera.size[0]), static_cast<float>(camera.size[1])}},
      {"step_size", static_cast<float>(scene.step)}};
  if (const auto* parallel = std::get_if<Orthographic>(&camera.projection)) {
    result["is_perspective"] = 0;
    result["height"] = static_cast<float>(parallel->height);
  } else {
    result["is_perspective"] = 1;
    result["angle_of_view"] =
        static_cast<float>(std::get<Perspective>(camera.projection).fov_y * std::numbers::pi / 180);
  }
  return result;
}

}  // namespace

TexturedScene textured_scene(const Grid& grid, const PiecewiseLinear& transfer, std::int64_t entries) {
  if (entries < 2) throw InputError(fmt::format("a transfer function of {} entries; at least 2 are allowed", entries));
  TexturedScene scene{.volume = {.size = grid.size, .dimensions = 3, .channels = 1},
                      .transfer = {.size = {entries, 1, 1}, .dimensions = 1, .channels = 4},
                      .spacing = grid.spacing,
                      .camera = {}};
  scene.volume.texels.reserve(grid.values.size());
  for (const double value : grid.values) scene.volume.texels.push_back(static_cast<float>(value));
  for (std::int64_t entry = 0; entry < entries; ++entry) {
    const Optics optics = transfer.at(static_cast<double>(entry) / static_cast<double>(entries - 1));
    for (const double color : optics.color) scene.transfer.texels.push_back(static_cast<float>(color));
    scene.transfer.texels.push_back(static_cast<float>(optics.extinction));
  }
  return scene;
}

Image draw_by_hand_written_renderer(GlDevice& device, const TexturedScene& scene) {
  const auto [width, height] = scene.camera.size;
  const std::vector<float> drawn =
      device.draw({.shader = renderer_shader,
                   .reads = {.uniforms = uniforms(scene),
                             .textures = {{"volume", for_sampling(scene.volume, TexelFormat::r32f)},
                                          {"transfer", for_sampling(scene.transfer, TexelFormat::rgba32f)}}},
                   .width = static_cast<std::size_t>(width),
                   .height = static_cast<std::size_t>(height)});
  Image image(scene.camera.size);
  const float* next = drawn.data();
  for (std::int64_t row = height - 1; row >= 0; --row)  // OpenGL begins at the bottom
    for (std::int64_t column = 0; column < width; ++column, next += 4)
      image.at(column, row) = {next[0], next[1], next[2], next[3]};
  return image;
}

}  // namespace raytruth
