#include "measures/images/surface_depths.hpp"

#include "raytruth/render/camera.hpp"
#include "raytruth/schemes/optics_lookup.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/skipping/clear_scalars.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <variant>

namespace raytruth {

namespace {

constexpr double longest_step = 1.0 / 64;

/// Where the chain has absorbed half of the light.
template <int Degree>
double surface_depth(const Chain<Degree>& chain, const ClearScalars& clear, const OpticsLookup<double>& look_up) {
  double optical_depth = 0;
  for (const auto& piece : chain.pieces) {
    const auto [low, high] =
        std::minmax_element(piece.polynomial.coefficients.begin(), piece.polynomial.coefficients.end());
    if (clear.contain(*low, *high)) continue;
    const int steps = std::max(1, static_cast<int>(std::ceil(piece.length / longest_step)));
    double front = look_up(piece.polynomial.value(0))[3];
    for (int i = 1; i <= steps; ++i) {
      const double back = look_up(piece.polynomial.value(static_cast<double>(i) / steps))[3];
      const double of_step = piece.length / steps * (front + back) / 2;
      if (optical_depth + of_step >= std::numbers::ln2) {
        const double share = (std::numbers::ln2 - optical_depth) / of_step;
        return static_cast<double>(piece.start) + piece.length * (i - 1 + share) / steps;
      }
      optical_depth += of_step;
      front = back;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<double> surface_depths(const Scene& scene) {
  const CameraView view(scene.camera, scene.grid.spacing);
  const RayField any_field = ray_field(scene.grid, scene.field, scene.border);
  const ClearScalars clear(scene.transfer, scene.emission);
  const OpticsLookup<double> look_up(scene.transfer, scene.emission);
  const auto [width, height] = scene.camera.size;
  std::vector<double> depths(static_cast<std::size_t>(width * height));
  std::visit(
      [&, columns = width]<class Field>(const Field& field) {
        tbb::parallel_for(std::int64_t{0}, height, [&](std::int64_t row) {
          Chain<Field::degree> chain;
          for (std::int64_t column = 0; column < columns; ++column) {
            const PixelRay pixel = view(column, row);
            field.trace(pixel.ray, chain);
            scale_lengths(chain, pixel.length_unit);
            depths[static_cast<std::size_t>(row * columns + column)] = surface_depth(chain, clear, look_up);
          }
        });
      },
      any_field);
  return depths;
}

}  // namespace raytruth
