#pragma once

#include "raytruth/images/image.hpp"

#include <optional>

namespace raytruth {

/// SSIM, the mean structural similarity of two images (Z. Wang et al., Image quality assessment: from error visibility
/// to structural similarity, 2004), of colours as they are: with means m, variances v and covariance c of both under a
/// Gaussian of deviation 1.5 pixels in windows of 11 x 11, and P the peak,
///     (2 m_a m_b + (0.01 P)^2) (2 c + (0.03 P)^2) / ((m_a^2 + m_b^2 + (0.01 P)^2) (v_a + v_b + (0.03 P)^2)),
/// averaged over all pixels whose window lies inside the image and over the channels: as scikit-image's
/// structural_similarity(gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=P). None for images
/// smaller than a window. Throws InputError for images of different size.
std::optional<double> structural_similarity(const Image& image, const Image& reference, double peak = 1);

}  // namespace raytruth
