#include "measures/images/pictures.hpp"

#include "raytruth/images/image_file.hpp"
#include "raytruth/images/png_file.hpp"
#include "raytruth/render/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace raytruth {

namespace {

PngPixels png_of(const Image& image) {
  return read_png(image_file(image, ".png"), largest_image_side, image.size[0] * image.size[1]);
}

/// `text_of(pixel)` of all pixels, line by line.
std::vector<PictureLine> lines_of(const Image& image, const std::function<std::string(std::size_t)>& text_of) {
  std::vector<PictureLine> lines;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (i % static_cast<std::size_t>(image.size[0]) == 0)
      lines.push_back({static_cast<std::int64_t>(lines.size()), {}});
    lines.back().pixels += text_of(i);
  }
  return lines;
}

}  // namespace

Image stored_frame(const Image& image) {
  const PngPixels stored = png_of(image);
  Image frame(image.size);
  for (std::size_t i = 0; i < frame.pixels.size(); ++i)
    for (std::size_t channel = 0; channel < 4; ++channel)
      frame.pixels[i][static_cast<Eigen::Index>(channel)] =
          static_cast<double>(stored.channels[4 * i + channel]) / stored.largest;
  return frame;
}

Image light_of_frame(const Image& image) {
  Image light = stored_frame(image);
  for (auto& pixel : light.pixels) pixel.head<3>() = pixel.head<3>().unaryExpr(&linear_of).eval();
  return light;
}

std::vector<PictureLine> color_lines(const Image& image) {
  const PngPixels stored = png_of(image);
  return lines_of(image, [&stored](std::size_t pixel) {
    const auto* const channels = stored.channels.data() + 4 * pixel;
    return fmt::format("{:02x}{:02x}{:02x}", channels[0], channels[1], channels[2]);
  });
}

std::vector<PictureLine> error_lines(const Image& image, const Image& truth, double gain) {
  return lines_of(image, [&](std::size_t pixel) {
    const auto color = [pixel](const Image& of) { return of.pixels[pixel].head<3>().max(0).min(1).eval(); };
    const double error = (color(image) - color(truth)).abs().maxCoeff();
    return fmt::format("{:02x}", std::lround(255 * std::min(1.0, gain * error)));
  });
}

Columns<PictureLine> picture_columns() {
  return {
      {.name = "line",
       .description = "of a picture, 0 on top; null: of the whole image",
       .is_key = true,
       .cell = &PictureLine::line},
      {.name = "pixels",
       .description = "of the line, two hexadecimal digits each: of an image red, green and blue in 8-bit sRGB; of a "
                      "comparison 255 times the gain times the largest error of a channel",
       .cell = &PictureLine::pixels},
  };
}

}  // namespace raytruth
