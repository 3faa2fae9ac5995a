#include "raytruth/images/image_error.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace raytruth {

namespace {

template <int Count>
ImageError error_of(const Image& image, const Image& reference, Eigen::Index first, double peak) {
  ImageError error;
  double magnitudes = 0;
  double squares = 0;
  double light = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Eigen::Array<double, Count, 1> truth = reference.pixels[i].segment<Count>(first);
    const Eigen::Array<double, Count, 1> difference = image.pixels[i].segment<Count>(first) - truth;
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
  const double count = Count * static_cast<double>(image.pixels.size());
  error.bias /= count;
  error.rmse = std::sqrt(squares / count);
  if (error.rmse > 0) error.psnr = 20 * std::log10(peak) - 20 * std::log10(error.rmse);
  if (light > 0) error.relative = magnitudes / light;
  return error;
}

}  // namespace

ImageError image_error(const Image& image, const Image& reference, Channels channels, double peak) {
  if (image.size != reference.size)
    throw InputError(fmt::format("images of {} x {} and {} x {} pixels; equal sizes are allowed", image.size[0],
                                 image.size[1], reference.size[0], reference.size[1]));
  switch (channels) {
    case Channels::color:
      return error_of<3>(image, reference, 0, peak);
    case Channels::opacity:
      return error_of<1>(image, reference, 3, peak);
    default:
      return error_of<4>(image, reference, 0, peak);
  }
}

ClampedImage clamped(const Image& image) {
  ClampedImage result{.image = image};
  for (Eigen::Array4d& pixel : result.image.pixels) {
    result.count += (pixel.head<3>() < 0 || pixel.head<3>() > 1).count();
    pixel = pixel.max(0).min(1);
  }
  return result;
}

}  // namespace raytruth
