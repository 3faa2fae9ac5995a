#include "raytruth/render/camera.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raytruth {

namespace {

// Directions whose angle has a smaller sine count as parallel.
constexpr double smallest_sine = 1e-9;

Eigen::Vector3d finite(const std::array<double, 3>& point, const char* name) {
  Eigen::Vector3d vector(point[0], point[1], point[2]);
  if (!vector.allFinite())
    throw InputError(fmt::format("{} [{}, {}, {}]; finite numbers are allowed", name, point[0], point[1], point[2]));
  return vector;
}

/// Half the image's height where rays have gone a unit forward (perspective), or anywhere (orthographic).
double half_height(const std::variant<Orthographic, Perspective>& projection) {
  if (const auto* parallel = std::get_if<Orthographic>(&projection)) {
    if (!(parallel->height > 0 && std::isfinite(parallel->height)))
      throw InputError(fmt::format("height {}; numbers > 0 are allowed", parallel->height));
    return parallel->height / 2;
  }
  const double angle = std::get<Perspective>(projection).fov_y;
  if (!(angle > 0 && angle < 180)) throw InputError(fmt::format("fov_y {}; 0 < fov_y < 180 is allowed", angle));
  return std::tan(angle / 2 * std::numbers::pi / 180);
}

double six_digits(double x) {
  if (x == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(x))) - 5);
  return std::round(x / unit) * unit;
}

}  // namespace

Camera fitted_camera(const std::array<std::int64_t, 3>& grid_size, const std::array<double, 3>& spacing,
                     const std::array<std::int64_t, 2>& image_size, const std::array<double, 3>& from) {
  constexpr double fov_y = 30;
  const Eigen::Vector3d direction = Eigen::Vector3d(from[0], from[1], from[2]).normalized();
  Eigen::Vector3d middle;
  Eigen::Vector3d sides;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const auto count = static_cast<double>(grid_size[axis]);
    middle[i] = spacing[axis] * (count - 1) / 2;
    sides[i] = spacing[axis] * count;
  }
  const double narrower = std::min(1.0, static_cast<double>(image_size[0]) / static_cast<double>(image_size[1]));
  const double half_angle = std::atan(narrower * std::tan(fov_y / 2 * std::numbers::pi / 180));
  const Eigen::Vector3d eye = middle + direction * (sides.norm() / 2 / std::sin(half_angle));
  // Upwards is along y, unless one looks along it.
  constexpr double steep = 0.9;
  Camera camera{.up = {0, 1, 0}, .projection = Perspective{fov_y}, .size = image_size};
  if (std::abs(direction[1]) > steep) camera.up = {0, 0, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    camera.eye[axis] = six_digits(eye[i]);
    camera.target[axis] = six_digits(middle[i]);
  }
  return camera;
}

CameraView::CameraView(const Camera& camera, const std::array<double, 3>& spacing)
    : is_perspective_(std::holds_alternative<Perspective>(camera.projection)),
      size_(camera.size),
      spacing_(spacing[0], spacing[1], spacing[2]),
      eye_(finite(camera.eye, "eye")),
      forward_((finite(camera.target, "target") - eye_).stableNormalized()) {
  if (forward_.isZero())
    throw InputError(fmt::format("eye and target [{}, {}, {}]; two points are allowed", camera.eye[0], camera.eye[1],
                                 camera.eye[2]));
  for (const std::int64_t side : size_)
    if (side < 1 || side > largest_image_side)
      throw InputError(fmt::format("an image of {} x {} pixels; 1 to {} along each side are allowed", size_[0],
                                   size_[1], largest_image_side));
  if (!((spacing_ > 0).all() && spacing_.allFinite()))
    throw InputError(fmt::format("spacing [{}, {}, {}]; numbers > 0 are allowed", spacing[0], spacing[1], spacing[2]));
  const Eigen::Vector3d right = forward_.cross(finite(camera.up, "up").stableNormalized());
  if (!(right.norm() > smallest_sine))
    throw InputError(fmt::format("up [{}, {}, {}]; a direction across the view from eye to target is allowed",
                                 camera.up[0], camera.up[1], camera.up[2]));
  const double half = half_height(camera.projection);
  to_right_ = right.normalized() * (half * static_cast<double>(size_[0]) / static_cast<double>(size_[1]));
  to_top_ = right.normalized().cross(forward_) * half;
}

PixelRay CameraView::operator()(std::int64_t column, std::int64_t row) const {
  const double x = (2 * static_cast<double>(column) + 1) / static_cast<double>(size_[0]) - 1;
  const double y = 1 - (2 * static_cast<double>(row) + 1) / static_cast<double>(size_[1]);
  const Eigen::Vector3d aside = x * to_right_ + y * to_top_;
  Eigen::Vector3d origin = eye_;
  Eigen::Vector3d world = forward_;
  (is_perspective_ ? world : origin) += aside;
  origin.array() /= spacing_;
  const Eigen::Vector3d voxels = world.array() / spacing_;
  const auto direction = unit_direction({voxels[0], voxels[1], voxels[2]});
  // A quotient, so that equal spacings give exactly 1.
  const Eigen::Vector3d unit(direction[0], direction[1], direction[2]);
  const Eigen::Vector3d in_smallest_spacings = unit.array() * spacing_ / spacing_.minCoeff();
  return {.ray = {.origin = {origin[0], origin[1], origin[2]}, .direction = direction},
          .length_unit = in_smallest_spacings.norm() / unit.norm()};
}

}  // namespace raytruth
