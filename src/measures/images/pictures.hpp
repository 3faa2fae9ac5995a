#pragma once

#include "experiments/row.hpp"
#include "raytruth/images/image.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// The stored values of an 8-bit sRGB file, over 255.
Image stored_frame(const Image& image);

/// The light that a viewer of that file sees.
Image light_of_frame(const Image& image);

/// Lines of an image in 8-bit sRGB, 0 on top: two hexadecimal digits for each of red, green and blue.
std::vector<std::string> color_lines(const Image& image);

/// Lines of an error: two hexadecimal digits of 255 times the gain times the largest one of a pixel's channels.
std::vector<std::string> error_lines(const Image& image, const Image& truth, double gain);

/// A row for every line of a picture: the keys, then `line` and `pixels`.
void add_picture(std::vector<Row>& rows, const Row& keys, const std::vector<std::string>& lines);

/// The columns of such rows.
std::vector<Column> picture_columns();

}  // namespace raytruth
