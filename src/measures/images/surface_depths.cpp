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
#include <optional>
#include <variant>

namespace raytruth {

namespace {

constexpr double longest_step = 1.0 / 64;
constexpr double shortest_step = 0x1p-20;
constexpr double largest_change = 1e-3;  // of the extinction in a step, times its length
constexpr double half_of_the_light = std::numbers::ln2;

/// Follows a piece of a ray until half of the light is absorbed.
template <int Degree>
class Follower {
 public:
  Follower(const OpticsLookup<double>& look_up, double& optical_depth)
      : look_up_(look_up), optical_depth_(optical_depth) {}

  /// Where in the piece this is, in smallest spacings behind its front; none if it is not.
  std::optional<double> operator()(const Bernstein<Degree>& scalar, double length) {
    const int steps = std::max(1, static_cast<int>(std::ceil(length / longest_step)));
    Place front = place(scalar, 0);
    for (int i = 1; i <= steps; ++i) {
      const Place back = place(scalar, static_cast<double>(i) / steps);
      if (const auto found = in_step(scalar, length, front, back)) return found;
      front = back;
    }
    return {};
  }

 private:
  struct Place {
    double u;
    double extinction;
  };

  [[nodiscard]] Place place(const Bernstein<Degree>& scalar, double u) const {
    return {u, look_up_(scalar.value(u))[3]};
  }

  /// Steps are halved where the extinction changes much, and where half of the light is reached.
  std::optional<double> in_step(const Bernstein<Degree>& scalar, double length, const Place& front, const Place& back) {
    const double width = (back.u - front.u) * length;
    const double of_step = width * (front.extinction + back.extinction) / 2;
    const bool ends_here = optical_depth_ + of_step >= half_of_the_light;
    const bool changes = std::abs(back.extinction - front.extinction) * width > largest_change;
    if (width > shortest_step && (ends_here || changes)) {
      const Place middle = place(scalar, front.u + (back.u - front.u) / 2);
      if (const auto found = in_step(scalar, length, front, middle)) return found;
      return in_step(scalar, length, middle, back);
    }
    if (ends_here) return front.u * length + width * (half_of_the_light - optical_depth_) / of_step;
    optical_depth_ += of_step;
    return {};
  }

  const OpticsLookup<double>& look_up_;
  double& optical_depth_;
};

/// Where the chain has absorbed half of the light.
template <int Degree>
double surface_depth(const Chain<Degree>& chain, const ClearScalars& clear, const OpticsLookup<double>& look_up) {
  double optical_depth = 0;
  Follower<Degree> follow(look_up, optical_depth);
  for (const auto& piece : chain.pieces) {
    const auto [low, high] =
        std::minmax_element(piece.polynomial.coefficients.begin(), piece.polynomial.coefficients.end());
    if (clear.contain(*low, *high)) continue;
    if (const auto found = follow(piece.polynomial, piece.length)) return static_cast<double>(piece.start) + *found;
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
