#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/documents/scene_case.hpp"
#include "raytruth/images/image_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace raytruth {

namespace {

struct CompareOptions {
  std::string reference;
  std::string image;
  std::string difference;  ///< file; empty: none
  double gain = 1;         ///< of the differences in it
};

/// |B - A| of each channel, times `gain`.
Image difference_image(const Image& a, const Image& b, double gain) {
  Image difference(a.size);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference.pixels[i] = gain * (b.pixels[i].max(0).min(1) - a.pixels[i].max(0).min(1)).abs();
    difference.pixels[i][3] = 1;
  }
  return difference;
}

int compare_images(const CompareOptions& options) {
  const Image a = read_image(options.reference);
  const Image b = read_image(options.image);
  nlohmann::ordered_json result{{"reference", std::filesystem::path(options.reference).filename().string()},
                                {"image", std::filesystem::path(options.image).filename().string()},
                                {"size", a.size}};
  result.update(image_error_json(b, a));
  if (!options.difference.empty()) {
    const std::filesystem::path file = options.difference;
    // Differences are no colours, so they are not encoded as such.
    write_whole(file,
                image_file(difference_image(a, b, options.gain), file.extension().string(), Transfer8Bit::linear));
    result["difference"] = file.filename().string();
    result["gain"] = options.gain;
  }
  print(result.dump(2) + "\n");
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<CompareOptions>();
  add.operand("reference", options->reference, ".pfm, .npy or .png (its stored values)");
  add.operand("image", options->image, "An image of the same size");
  add.text("--difference", "FILE", options->difference, "Write the magnitudes of the differences into this image");
  add.positive_number("--gain", options->gain, "Times this (default: 1)");
  return [options] { return compare_images(*options); };
}

}  // namespace

extern const Command compare_command;
const Command compare_command{
    .name = "compare",
    .summary = "Tell how far an image is from a reference",
    .example = "raytruth compare truth.pfm image.pfm",
    .notes =
        "Colours are clamped to [0, 1]; PSNR has the peak 1. `danskin_hanrahan` is 100 sum |I - R| / sum R, in\n"
        "percent; `ssim` that of Wang et al. 2004, windows of 11 x 11.",
    .describe = describe};

}  // namespace raytruth
