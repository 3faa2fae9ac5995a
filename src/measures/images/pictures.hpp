#pragma once

#include "experiments/columns.hpp"
#include "raytruth/images/image.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace raytruth {

/// The stored values of an 8-bit sRGB file, over 255.
Image stored_frame(const Image& image);

/// The light that a viewer of that file sees.
Image light_of_frame(const Image& image);

/// A line of a picture that a result holds.
struct PictureLine {
  std::int64_t line;   ///< 0 on top
  std::string pixels;  ///< in hexadecimal digits
};

/// An image in 8-bit sRGB: two hexadecimal digits for each of red, green and blue.
std::vector<PictureLine> color_lines(const Image& image);

/// An error: two hexadecimal digits of 255 times the gain times the largest one of a pixel's channels.
std::vector<PictureLine> error_lines(const Image& image, const Image& truth, double gain);

/// `line` and `pixels`.
Columns<PictureLine> picture_columns();

}  // namespace raytruth
