#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// The pixels of a PNG image: red, green, blue, opacity of each, as they are stored, 8 or 16 bits wide.
struct PngPixels {
  std::array<std::int64_t, 2> size{};  ///< width and height
  int largest = 255;                   ///< 255, or 65535
  bool has_opacity = false;            ///< else all are opaque
  bool is_srgb = false;                ///< declared so; stored colours are linear light ^ gamma else, if there is one
  std::optional<double> gamma = {};
  std::vector<std::uint16_t> channels = {};
};

/// Throws InputError, without a place, for what is no whole PNG image and for more than `largest_side` pixels along a
/// side or `most_pixels` in all.
PngPixels read_png(const std::string& bytes, std::int64_t largest_side, std::int64_t most_pixels);

/// A PNG image of 8 bits for each of red, green and blue, three bytes for each pixel, row 0 on top; declared as sRGB,
/// or as linear by a gamma of 1.
std::string write_png(const std::vector<unsigned char>& pixels, const std::array<std::int64_t, 2>& size, bool is_srgb);

}  // namespace raytruth
