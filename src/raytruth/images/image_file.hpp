#pragma once

#include "raytruth/images/image.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// How an 8-bit file encodes linear light.
enum class Transfer8Bit {
  srgb,    ///< IEC 61966-2-1
  linear,  ///< as it is
};

/// The numbers of a .npy file; .pfm has binary32 only.
enum class NpyNumbers { binary32, binary64 };

/// The bytes of an image file:
///     .png  8 bits, red, green, blue: light over black, clamped to [0, 1] and rounded to nearest (halves up)
///     .pfm  binary32 red, green, blue as they are, little-endian, the lowest row first
///     .npy  binary32 or binary64 red, green, blue, opacity, shape (height, width, 4), C order, row 0 on top
/// Throws InputError for other extensions.
std::string image_file(const Image& image, std::string_view extension, Transfer8Bit transfer = Transfer8Bit::srgb,
                       NpyNumbers numbers = NpyNumbers::binary32);

/// The bytes of a .npy file with one number for each pixel: binary64, shape (height, width).
std::string number_file(const std::vector<double>& numbers, const std::array<std::int64_t, 2>& size);

/// What an image file says of the numbers in it.
struct StoredImage {
  Image image;                       ///< the numbers as they are stored, those of .png over the largest
  bool has_opacity = false;          ///< else every opacity is 1
  bool is_png = false;               ///< .pfm and .npy hold linear light, opacity-weighted: over black
  bool is_srgb = false;              ///< a .png says so
  std::optional<double> gamma = {};  ///< a .png says that it stores linear light ^ gamma; 1: linear light
};

/// Reads .png (8 or 16 bits per channel, grey or colour, whatever they encode; alpha is the opacity), .pfm (grey or
/// colour) and .npy (binary32 or binary64, little-endian, C order, shape (height, width) or with 1, 3 or 4 channels).
/// Throws InputError for what is none of these, damaged, not finite, or larger than `largest_image_side` along a side
/// or 2^28 pixels in all.
StoredImage read_image(const std::filesystem::path& file);

/// Reads a .npy file's bytes likewise; `name` is what messages call it.
StoredImage image_of_npy(const std::filesystem::path& name, const std::string& bytes);

/// Linear light of [0, 1] as sRGB encodes it, and back.
double srgb_of(double linear);
double linear_of(double srgb);

}  // namespace raytruth
