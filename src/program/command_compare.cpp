#include "experiments/output.hpp"
#include "program/commands.hpp"
#include "raytruth/documents/scene_case.hpp"
#include "raytruth/images/image_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace raytruth {

namespace {

/// |B - A| of each channel, times `gain`.
Image difference_image(const Image& a, const Image& b, double gain) {
  Image difference(a.size);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference.pixels[i] = gain * (b.pixels[i].max(0).min(1) - a.pixels[i].max(0).min(1)).abs();
    difference.pixels[i][3] = 1;
  }
  return difference;
}

}  // namespace

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

}  // namespace raytruth
