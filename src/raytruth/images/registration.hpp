#pragma once

#include "raytruth/images/image.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace raytruth {

/// What is done to an image, in this order, before it is compared: two renderers may disagree on nothing but where the
/// first row is, how large a pixel, or what the number for white is.
struct Registration {
  std::int64_t reference_block =
      1;                         ///< the reference's pixels are means of blocks with so many of its own along a side
  std::int64_t image_block = 1;  ///< and so the image's
  bool is_transposed = false;    ///< columns become rows
  bool is_mirrored = false;      ///< left becomes right
  bool is_upside_down = false;   ///< top becomes bottom
  std::array<std::int64_t, 2> moved{};  ///< to the right and down, whole pixels; both are cut to what they share
  double factor = 1;                    ///< of the image's colours
  bool scales_opacity = false;          ///< and of its opacities

  [[nodiscard]] bool operator==(const Registration&) const = default;

  /// "flipped left to right and moved by 2 pixels to the left"; empty where nothing is done.
  [[nodiscard]] std::string words() const;
};

/// The registration by which an image comes far closer to a reference, to less than a quarter of its root mean square
/// error; nothing is done where there is none. Flips, and moves by up to half a side, are those of the largest
/// correlation; the factor is that of least squares, or a round one next to it. Parts that do not halve the error are
/// left out. None for images whose sizes differ by no whole factor.
std::optional<Registration> registration(const Image& image, const Image& reference);

/// Two images of equal size.
struct Registered {
  Image image;
  Image reference;
};

/// What is left to compare. Throws InputError where nothing is.
Registered registered(const Registration& registration, const Image& image, const Image& reference);

}  // namespace raytruth
