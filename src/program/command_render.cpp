#include "experiments/output.hpp"
#include "program/command.hpp"
#include "program/progress_bar.hpp"
#include "raytruth/documents/scene_document.hpp"
#include "raytruth/images/image_file.hpp"
#include "raytruth/render/renderer.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <string>

namespace raytruth {

namespace {

struct RenderOptions {
  std::string scene;
  std::string file;  ///< of the image
  int threads = 0;
  bool is_linear = false;              ///< 8 bits are linear light, not sRGB
  std::optional<std::string> opacity;  ///< a transfer function's file, whose opacities are taken
  bool ignores_gradient_opacity = false;
  VolumeOptions volumes;
};

/// Renders, telling on a terminal how far it is.
Rendering render(const Renderer& renderer) {
  constexpr std::size_t parts = 100;
  ProgressBar bar(parts);
  std::size_t told = 0;
  bar.show("rendering");
  return renderer.render([&](std::size_t done, std::size_t of) {
    for (const std::size_t now = parts * done / of; told < now; ++told) bar.advance();
    bar.show("rendering");
  });
}

int render_scene(const RenderOptions& options) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const std::filesystem::path file = options.file;
  const auto transfer = options.is_linear ? Transfer8Bit::linear : Transfer8Bit::srgb;
  image_file(Image({1, 1}), file.extension().string(), transfer);  // refuses the name before anything is rendered

  const JsonReader json = JsonReader::from_file(options.scene);
  SceneFile scene = read_scene(json, {.volumes = volume_access(options.volumes),
                                      .opacity = options.opacity,
                                      .ignores_gradient_opacity = options.ignores_gradient_opacity});
  for (const std::string& warning : scene.warnings) say(warning);
  const auto size = scene.scene.camera.size;
  nlohmann::ordered_json result{{"image", file.filename().string()},
                                {"size", size},
                                {"scheme", scene.scene.scheme},
                                {"volume", std::move(scene.volume)},
                                {"transfer_function", std::move(scene.transfer_function)}};
  if (!scene.warnings.empty()) result["warnings"] = scene.warnings;
  const Rendering rendering = json.at("scheme").blame_for([&] { return render(Renderer(std::move(scene.scene))); });
  if (file.extension() == ".png") result["encoding"] = options.is_linear ? "linear" : "sRGB";
  write_whole(file, image_file(rendering.image, file.extension().string(), transfer));
  if (!rendering.radii.empty()) {
    std::filesystem::path radii = file;
    radii.replace_filename(file.stem().string() + ".radius.npy");
    result["radius_image"] = radii.filename().string();
    const double radius = *std::max_element(rendering.radii.begin(), rendering.radii.end());
    if (rendering.is_certified) {
      result["error_bound"] = radius;
    } else {
      result["measured_radius"] = radius;
      result["radius"] =
          "sum of the differences of two quadratures (7 and 15 nodes) over all panels of a ray: an "
          "estimate, not a bound; rounding is left out";
    }
    result["not_converged"] = rendering.not_converged;
    write_whole(radii, number_file(rendering.radii, size));
  }
  print(result.dump(2) + "\n");
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<RenderOptions>();
  add.operand("scene", options->scene, "JSON file; '-' is standard input");
  add.required_text("-o", "FILE", options->file,
                    "The image: .png (8 bits, over black), .pfm or .npy (linear light, binary32)");
  add.threads(options->threads);
  add.flag("--linear", options->is_linear, "Write linear light into a .png, instead of sRGB");
  add.text("--opacity", "FILE", options->opacity,
           "Take the opacities of this transfer function, for colour maps without");
  add.flag("--ignore-gradient-opacity", options->ignores_gradient_opacity,
           "Accept transfer functions whose opacity depends on the gradient, and leave that out");
  add.data(options->volumes);
  add.nan(options->volumes);
  return [options] { return render_scene(*options); };
}

}  // namespace

extern const Command render_command;
const Command render_command{.name = "render",
                             .summary = "Render a scene, by any scheme or certified",
                             .example = "raytruth render scene.json -o image.png",
                             .notes = "",
                             .describe = describe};

}  // namespace raytruth
