#pragma once

#include "raytruth/images/image.hpp"

#include <nlohmann/json_fwd.hpp>

namespace raytruth {

/// How far an image is from a reference, in the words of `raytruth compare`. At the top level of colours, values as
/// they are: Danskin and Hanrahan's error in per cent, RMSE, PSNR with its peak, the maximum with its pixel, bias and
/// SSIM. `opacity` and `all_channels` hold those of opacities, and of colours and opacities together, where both images
/// have opacities; `clamped` those of colours as a screen shows them, clamped to [0, 1], with how many were. Throws
/// InputError for images of different size.
nlohmann::ordered_json image_error_json(const Image& image, const Image& reference, bool have_opacity = true,
                                        double peak = 1);

}  // namespace raytruth
