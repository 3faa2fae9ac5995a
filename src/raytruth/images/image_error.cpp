#include "raytruth/images/image_error.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace raytruth {

namespace {

Eigen::Array3d clamped_color(const Eigen::Array4d& pixel) { return pixel.head<3>().max(0).min(1); }

}  // namespace

ImageError image_error(const Image& image, const Image& reference) {
  if (image.size != reference.size)
    throw InputError(fmt::format("images of {} x {} and {} x {} pixels; equal sizes are allowed", image.size[0],
                                 image.size[1], reference.size[0], reference.size[1]));
  ImageError error;
  double magnitudes = 0;
  double squares = 0;
  double light = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Eigen::Array3d truth = clamped_color(reference.pixels[i]);
    const Eigen::Array3d difference = clamped_color(image.pixels[i]) - truth;
    const double largest = difference.abs().maxCoeff();
    if (largest > error.maximum) {
      const auto place = static_cast<std::int64_t>(i);
      error.maximum = largest;
      error.place = {place % image.size[0], place / image.size[0]};
    }
    error.bias += difference.sum();
    magnitudes += difference.abs().sum();
    squares += difference.square().sum();
    light += truth.sum();
  }
  const double count = 3 * static_cast<double>(image.pixels.size());
  error.bias /= count;
  error.rmse = std::sqrt(squares / count);
  if (error.rmse > 0) error.psnr = -20 * std::log10(error.rmse);
  if (light > 0) error.relative = magnitudes / light;
  return error;
}

}  // namespace raytruth
