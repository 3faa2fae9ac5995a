#pragma once

#include "raytruth/images/image.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace raytruth {

/// Which channels of an image are compared.
enum class Channels { color, opacity, all };

/// How far an image I is from a reference I_r, over all pixels and some of the channels, values as they are.
struct ImageError {
  double maximum = 0;                   ///< of |I - I_r|
  std::array<std::int64_t, 2> place{};  ///< column and row of the first pixel where it occurs
  double bias = 0;                      ///< mean of I - I_r
  double rmse = 0;                      ///< root mean square of I - I_r
  std::optional<double> psnr;           ///< 20 log10(peak / rmse), dB; none for equal images
  std::optional<double> relative;       ///< sum |I - I_r| / sum I_r (Danskin and Hanrahan 1992); none over black
};

/// Throws InputError for images of different size.
ImageError image_error(const Image& image, const Image& reference, Channels channels = Channels::color,
                       double peak = 1);

/// An image as a screen shows it.
struct ClampedImage {
  Image image;             ///< colours and opacities clamped to [0, 1]
  std::int64_t count = 0;  ///< colours that were not in it
};
ClampedImage clamped(const Image& image);

}  // namespace raytruth
