#include "raytruth/documents/image_comparison.hpp"

#include "raytruth/images/image_error.hpp"
#include "raytruth/images/structural_similarity.hpp"

#include <nlohmann/json.hpp>

#include <optional>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json color_json(const Image& image, const Image& reference, double peak) {
  const ImageError error = image_error(image, reference, Channels::color, peak);
  Json result{{"danskin_hanrahan", nullptr}, {"rmse", error.rmse},
              {"psnr", or_null(error.psnr)}, {"psnr_peak", peak},
              {"maximum", error.maximum},    {"maximum_pixel", error.place},
              {"bias", error.bias},          {"ssim", or_null(structural_similarity(image, reference, peak))}};
  if (error.relative) result["danskin_hanrahan"] = 100 * *error.relative;
  return result;
}

Json channels_json(const Image& image, const Image& reference, Channels channels) {
  const ImageError error = image_error(image, reference, channels);
  return {{"rmse", error.rmse}, {"maximum", error.maximum}, {"maximum_pixel", error.place}, {"bias", error.bias}};
}

}  // namespace

Json image_error_json(const Image& image, const Image& reference, bool have_opacity, double peak) {
  Json result = color_json(image, reference, peak);
  if (have_opacity) {
    result["opacity"] = channels_json(image, reference, Channels::opacity);
    result["all_channels"] = channels_json(image, reference, Channels::all);
  } else {
    result["opacity"] = nullptr;
    result["all_channels"] = channels_json(image, reference, Channels::color);
  }
  const ClampedImage shown = clamped(image);
  const ClampedImage shown_reference = clamped(reference);
  Json on_screen = color_json(shown.image, shown_reference.image, 1);
  on_screen["clamped_values"] = {{"reference", shown_reference.count}, {"image", shown.count}};
  result["clamped"] = std::move(on_screen);
  return result;
}

}  // namespace raytruth
