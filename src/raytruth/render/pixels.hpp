#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/volume/grid.hpp"

#include <cstdint>
#include <functional>

namespace raytruth {

/// What a renderer without approximation knows of a pixel.
struct Pixel {
  std::int64_t column;
  std::int64_t row;
  const PixelRay& ray;
  const Chain<3>& signal;  ///< the trilinear scalar along the ray, from where it enters; lengths in smallest spacings
};

/// Calls work(pixel) for every pixel of the image, in parallel: it writes to places of the pixel's own. Throws
/// InputError as CameraView does.
void for_each_pixel(const Grid& grid, const Camera& camera, const std::function<void(const Pixel&)>& work);

}  // namespace raytruth
