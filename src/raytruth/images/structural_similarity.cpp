#include "raytruth/images/structural_similarity.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t reach = 5;
constexpr std::int64_t window = 2 * reach + 1;
std::array<double, window> gaussian() {
  constexpr double deviation = 1.5;
  std::array<double, window> weights{};
  double sum = 0;
  for (std::int64_t i = 0; i < window; ++i) {
    const double x = static_cast<double>(i - reach) / deviation;
    sum += weights[static_cast<std::size_t>(i)] = std::exp(-x * x / 2);
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// a, b, a^2, b^2, a b of two numbers, or their weighted means.
using Moments = Eigen::Array<double, 5, 1>;

}  // namespace

std::optional<double> structural_similarity(const Image& image, const Image& reference, double peak) {
  if (image.size != reference.size)
    throw InputError(fmt::format("images of {} x {} and {} x {} pixels; equal sizes are allowed", image.size[0],
                                 image.size[1], reference.size[0], reference.size[1]));
  const auto [width, height] = image.size;
  if (width < window || height < window) return std::nullopt;
  // The smallest numbers that keep quotients of nothing defined.
  const double of_means = (0.01 * 0.01) * (peak * peak);
  const double of_variances = (0.03 * 0.03) * (peak * peak);
  const auto weights = gaussian();
  const auto inner_width = static_cast<std::size_t>(width - 2 * reach);
  std::vector<Moments> along_rows(inner_width * static_cast<std::size_t>(height));
  double sum = 0;
  for (int channel = 0; channel < 3; ++channel) {
    for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row)
      for (std::size_t column = 0; column < inner_width; ++column) {
        Moments& moments = along_rows[row * inner_width + column];
        moments.setZero();
        for (std::size_t i = 0; i < weights.size(); ++i) {
          const std::size_t pixel = row * static_cast<std::size_t>(width) + column + i;
          const double a = image.pixels[pixel][channel];
          const double b = reference.pixels[pixel][channel];
          moments += weights[i] * (Moments() << a, b, a * a, b * b, a * b).finished();
        }
      }
    for (std::size_t row = 0; row + 2 * reach < static_cast<std::size_t>(height); ++row)
      for (std::size_t column = 0; column < inner_width; ++column) {
        Moments m = Moments::Zero();
        for (std::size_t i = 0; i < weights.size(); ++i) m += weights[i] * along_rows[(row + i) * inner_width + column];
        const double variances = (m[2] - m[0] * m[0]) + (m[3] - m[1] * m[1]);
        const double covariance = m[4] - m[0] * m[1];
        sum += (2 * m[0] * m[1] + of_means) * (2 * covariance + of_variances) /
               ((m[0] * m[0] + m[1] * m[1] + of_means) * (variances + of_variances));
      }
  }
  return sum / (3 * static_cast<double>(inner_width) * static_cast<double>(height - 2 * reach));
}

}  // namespace raytruth
