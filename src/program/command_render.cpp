#include "experiments/output.hpp"
#include "program/command.hpp"
#include "program/progress_bar.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/outside_image.hpp"
#include "raytruth/documents/rendering_json.hpp"
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
  bool is_binary64 = false;            ///< a .npy holds binary64
  std::optional<std::string> opacity;  ///< a transfer function's file, whose opacities are taken
  bool ignores_gradient_opacity = false;
  bool runs_programs = false;
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

/// The image of the program that the scene names in place of a scheme.
OutsideImage image_by_program(const SceneFile& scene, const JsonReader& place, bool runs_programs) {
  if (!runs_programs) place.refuse("a program", "a scheme, or the option --programs,");
  const auto blame = [&](const OutsideRefusal& refusal) {
    return fmt::format("{}: {}: {}", place.place(), one_line(scene.program->name), refusal.what());
  };
  try {
    return outside_image(*scene.program, scene.scene, scene.document);
  } catch (const OutsideMissing& refusal) {
    throw MissingError(blame(refusal));
  } catch (const OutsideRefusal& refusal) {
    throw InputError(blame(refusal));
  }
}

/// The radii of `reference` beside its image: those of the numbers that the file holds. A picture of 8 bits has none.
void write_radii(const Rendering& rendering, const std::filesystem::path& file, bool is_binary64,
                 nlohmann::ordered_json& result) {
  std::filesystem::path radii = file;
  radii.replace_filename(file.stem().string() + ".radius.npy");
  result["radius_image"] = radii.filename().string();
  const bool is_picture = file.extension() == ".png";
  Rendering stored{.image = rendering.image,
                   .radii = is_picture || is_binary64 ? rendering.radii : radii_in_binary32(rendering),
                   .is_certified = rendering.is_certified,
                   .covers_camera = rendering.covers_camera,
                   .tolerance = rendering.tolerance,
                   .not_converged = rendering.not_converged,
                   .unresolved = rendering.unresolved};
  result.update(radius_json(stored));
  if (is_picture) {
    result["bound_holds_for"] =
        "linear light in binary64, before it is clamped, encoded and rounded to the picture's 8 bits; not for the "
        "picture";
  } else {
    result["bound_holds_for"] = is_binary64 ? "the binary64 numbers in the file"
                                            : "the binary32 numbers in the file: their rounding is covered";
    if (!is_binary64)
      result["radius_before_rounding"] = *std::max_element(rendering.radii.begin(), rendering.radii.end());
  }
  write_whole(radii, number_file(stored.radii, rendering.image.size));
}

int render_scene(const RenderOptions& options) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const std::filesystem::path file = options.file;
  const auto transfer = options.is_linear ? Transfer8Bit::linear : Transfer8Bit::srgb;
  const auto numbers = options.is_binary64 ? NpyNumbers::binary64 : NpyNumbers::binary32;
  if (options.is_binary64 && file.extension() != ".npy")
    throw InputError(fmt::format("command line: --binary64: found -o {}; a name that ends in .npy is allowed",
                                 one_line(options.file)));
  image_file(Image({1, 1}), file.extension().string(), transfer);  // refuses the name before anything is rendered

  const JsonReader json = JsonReader::from_file(options.scene);
  SceneFile scene = read_scene(json, {.volumes = volume_access(options.volumes),
                                      .opacity = options.opacity,
                                      .ignores_gradient_opacity = options.ignores_gradient_opacity,
                                      .only_renders = true});
  for (const std::string& warning : scene.warnings) say(warning);
  const auto size = scene.scene.camera.size;
  scene.scene.covers_camera = true;
  nlohmann::ordered_json result{{"image", file.filename().string()},
                                {"size", size},
                                {"scheme", scene.program ? scene.program->name : scene.scene.scheme},
                                {"volume", std::move(scene.volume)},
                                {"border", scene.scene.mesh ? std::string_view("mesh") : name_of(scene.scene.border)},
                                {"transfer_function", std::move(scene.transfer_function)}};
  if (!scene.fitted_camera.is_null()) result["fitted_camera"] = scene.fitted_camera;
  if (!scene.warnings.empty()) result["warnings"] = scene.warnings;
  if (file.extension() == ".png") result["encoding"] = options.is_linear ? "linear" : "sRGB";
  if (scene.program) {
    const OutsideImage found = image_by_program(scene, json.at("scheme"), options.runs_programs);
    if (found.version) result["version"] = *found.version;
    write_whole(file, image_file(found.image, file.extension().string(), transfer, numbers));
    print(result.dump(2) + "\n");
    return 0;
  }
  const Rendering rendering = json.at("scheme").blame_for([&] { return render(Renderer(std::move(scene.scene))); });
  write_whole(file, image_file(rendering.image, file.extension().string(), transfer, numbers));
  if (!rendering.radii.empty()) write_radii(rendering, file, options.is_binary64, result);
  print(result.dump(2) + "\n");
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<RenderOptions>();
  add.operand("scene", options->scene, "JSON file; '-' is standard input");
  add.required_text("-o", "FILE", options->file,
                    "The image: .png (8 bits, over black), .pfm or .npy (linear light, binary32)");
  add.threads(options->threads);
  add.programs(options->runs_programs);
  add.flag("--linear", options->is_linear, "Write linear light into a .png, instead of sRGB");
  add.flag("--binary64", options->is_binary64, "Write binary64 into a .npy: all digits of a certified image");
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
const Command render_command{
    .name = "render",
    .summary = "Render a scene: by any scheme, or the true image, certified without light and estimated with it",
    .example = "raytruth render scene.json -o image.png",
    .notes =
        "With the scheme \"reference\" an image of radii is written beside it. Without light it is "
        "certified: the\n"
        "radius is proven, for the scene as its numbers say it and the numbers that a .npy or "
        ".pfm holds; the\n"
        "rounding of the camera's rays and of binary32 is covered. With light it is an "
        "estimate: the radius is\n"
        "measured, not proven, and for rays as rounded to binary64. A .png has no bound. "
        "Where a scene has no\n"
        "camera, one is fitted around the volume and stated.\n"
        "\n"
        "Where the volume ends is a convention, which a scene's \"border\" says and the answer states:\n"
        "\"half_voxel\" (the default), half a voxel beyond the centres of its outermost voxels, or\n"
        "\"voxel_centres\", at these centres, as VTK's mappers and Teem have it.\n"
        "\n"
        "The scheme may be a program, {\"program\": [\"python3\", \"mine.py\"], \"name\": \"mine\"}: it reads the "
        "scene\n"
        "as JSON and writes a .npy; with --programs only.",
    .describe = describe};

}  // namespace raytruth
