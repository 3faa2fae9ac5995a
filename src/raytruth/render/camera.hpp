#pragma once

#include "raytruth/images/image.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/signals/ray_displacement.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <variant>

namespace raytruth {

/// Parallel rays through an image of this height in world units.
struct Orthographic {
  double height = 1;
};

/// Rays from one point, the vertical angle of view being `fov_y` degrees.
struct Perspective {
  double fov_y = 45;
};

/// Who looks at a volume, in world coordinates: voxel times spacing.
struct Camera {
  std::array<double, 3> eye{};
  std::array<double, 3> target{};
  std::array<double, 3> up{};
  std::variant<Orthographic, Perspective> projection = {};
  std::array<std::int64_t, 2> size{};  ///< width and height in pixels
};

/// A perspective view of the whole grid, by default from its front, above and to the right: the sphere around it fills
/// the narrower side of an image of this size. `from` points from its middle to the eye, in any length. The numbers
/// have six digits, so that they can be copied.
Camera fitted_camera(const std::array<std::int64_t, 3>& grid_size, const std::array<double, 3>& spacing,
                     const std::array<std::int64_t, 2>& image_size,
                     const std::array<double, 3>& from = {1, 0.75, -1.5});

/// What a pixel sees.
struct PixelRay {
  Ray ray;                 ///< in voxel coordinates; begins at the eye, or on the plane through it across the view
  double length_unit = 1;  ///< of one t of the ray, in smallest spacings: the unit of steps and of extinctions' lengths
  RayDisplacement displacement = {};  ///< of the ray that the camera means, where it was asked for: `CameraRounding`
};

/// Makes rays of pixels. With f, r, u the unit vectors forward, right and up, a the image's width over its height, and
/// h half its height (orthographic) or tan(fov_y / 2) (perspective), the pixel's centre has
///     x = a h (2 (column + 1/2) / width - 1),  y = h (1 - 2 (row + 1/2) / height),
/// row 0 being the topmost; its ray is
///     eye + x r + y u + t f   (orthographic)   or   eye + t (f + x r + y u)   (perspective),
/// in binary64: every number of it is rounded.
class CameraView {
 public:
  /// Throws InputError unless eye, target and up are finite and span a plane, 0 < height, 0 < fov_y < 180, all
  /// spacings are positive, and the image has 1 to `largest_image_side` pixels along each side.
  CameraView(const Camera& camera, const std::array<double, 3>& spacing);

  [[nodiscard]] PixelRay operator()(std::int64_t column, std::int64_t row) const;

 private:
  bool is_perspective_;
  std::array<std::int64_t, 2> size_;
  Eigen::Array3d spacing_;
  Eigen::Vector3d eye_;
  Eigen::Vector3d forward_;
  Eigen::Vector3d to_right_;  ///< from the image's centre to the middle of its right border
  Eigen::Vector3d to_top_;    ///< and to that of its upper border
};

}  // namespace raytruth
