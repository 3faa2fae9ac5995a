#include "raytruth/render/camera_rounding.hpp"

#include "raytruth/reference/arb/arb_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace raytruth {

namespace {

using arb::Ball;
using BallVector = std::array<Ball, 3>;

BallVector exactly(const std::array<double, 3>& v) { return {Ball(v[0]), Ball(v[1]), Ball(v[2])}; }

template <class Combine>
BallVector combined(const BallVector& a, const BallVector& b, const Combine& combine) {
  return {combine(a[0], b[0]), combine(a[1], b[1]), combine(a[2], b[2])};
}

BallVector operator+(const BallVector& a, const BallVector& b) {
  return combined(a, b, [](const Ball& x, const Ball& y) { return x + y; });
}
BallVector operator-(const BallVector& a, const BallVector& b) {
  return combined(a, b, [](const Ball& x, const Ball& y) { return x - y; });
}
BallVector operator*(const BallVector& a, const Ball& factor) { return {a[0] * factor, a[1] * factor, a[2] * factor}; }
BallVector quotients(const BallVector& a, const BallVector& b) {
  return combined(a, b, [](const Ball& x, const Ball& y) { return x / y; });
}

Ball norm(const BallVector& v) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

BallVector normalised(const BallVector& v) {
  const Ball length = norm(v);
  return {v[0] / length, v[1] / length, v[2] / length};
}

BallVector cross(const BallVector& a, const BallVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const Ball& x) { return arb_is_zero(x.get()) != 0; }

/// A ray at a unit direction, in voxels.
struct BallRay {
  BallVector origin;
  BallVector direction;

  [[nodiscard]] BallVector at(const Ball& t) const { return origin + direction * t; }
};

/// Where a ray is inside of the field.
struct BallSpan {
  Ball begin;
  Ball end;
  bool is_known = true;  ///< if not, it may be anywhere, or nowhere

  [[nodiscard]] Ball length() const { return max(end - begin, 0.0); }
};

BallSpan clipped(const BallRay& ray, const std::array<std::int64_t, 3>& size, Border border) {
  BallSpan span;
  // Beyond what the ray can have gone when it leaves the field.
  Ball farthest = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    farthest += ray.origin[axis].magnitude() + Ball(static_cast<double>(size[axis]));
  bool has_end = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Ball low = -margin_of(border);
    const Ball high = Ball(static_cast<double>(size[axis] - 1)) + margin_of(border);
    const Ball& origin = ray.origin[axis];
    const Ball& direction = ray.direction[axis];
    if (const int sign = direction.sign(); sign != 0) {
      const Ball of_low = (low - origin) / direction;
      const Ball of_high = (high - origin) / direction;
      span.begin = max(span.begin, sign > 0 ? of_low : of_high);
      const Ball& end = sign > 0 ? of_high : of_low;
      span.end = has_end ? min(span.end, end) : end;
      has_end = true;
      continue;
    }
    // Hardly anything moves along this axis, or nothing does.
    const Ball way = is_zero(direction) ? origin : hull(origin, origin + farthest * direction);
    if (low <= way && way <= high) continue;
    if (way < low || high < way) return {};
    span.is_known = false;
  }
  return span;
}

double upper_magnitude(const Ball& x) { return x.magnitude().upper_double(); }

}  // namespace

struct CameraRounding::Parts {
  bool is_perspective;
  std::array<std::int64_t, 2> image_size;
  std::array<std::int64_t, 3> size;
  Border border;
  BallVector spacing;
  Ball smallest_spacing;
  BallVector eye;
  BallVector forward;
  BallVector to_right;
  BallVector to_top;

  Parts(const Camera& camera, const std::array<double, 3>& its_spacing, const std::array<std::int64_t, 3>& its_size,
        Border its_border)
      : is_perspective(std::holds_alternative<Perspective>(camera.projection)),
        image_size(camera.size),
        size(its_size),
        border(its_border),
        spacing(exactly(its_spacing)),
        smallest_spacing(*std::min_element(its_spacing.begin(), its_spacing.end())),
        eye(exactly(camera.eye)),
        forward(normalised(exactly(camera.target) - eye)) {
    const BallVector right = normalised(cross(forward, exactly(camera.up)));
    Ball half;
    if (const auto* const parallel = std::get_if<Orthographic>(&camera.projection)) {
      half = Ball(parallel->height) / 2.0;
    } else {
      const Ball angle = Ball(std::get<Perspective>(camera.projection).fov_y) * Ball::pi() / 360.0;
      arb_tan(half.get(), angle.get(), arb::precision);
    }
    to_right = right * (half * Ball(static_cast<double>(image_size[0])) / Ball(static_cast<double>(image_size[1])));
    to_top = cross(right, forward) * half;
  }

  /// The ray that is meant, and the length of one voxel along it in smallest spacings.
  [[nodiscard]] std::pair<BallRay, Ball> meant(std::int64_t column, std::int64_t row) const {
    const auto centre = [](std::int64_t index, std::int64_t count) {
      return Ball(static_cast<double>(2 * index + 1)) / Ball(static_cast<double>(count));
    };
    const BallVector aside =
        to_right * (centre(column, image_size[0]) - 1.0) + to_top * (Ball(1.0) - centre(row, image_size[1]));
    const BallVector origin = is_perspective ? eye : eye + aside;
    const BallVector world = is_perspective ? forward + aside : forward;
    const BallVector voxels = quotients(world, spacing);
    return {{quotients(origin, spacing), normalised(voxels)}, norm(world) / norm(voxels) / smallest_spacing};
  }
};

CameraRounding::CameraRounding(const Camera& camera, const std::array<double, 3>& spacing,
                               const std::array<std::int64_t, 3>& size, Border border)
    : parts_(std::make_unique<const Parts>(camera, spacing, size, border)) {}
CameraRounding::~CameraRounding() = default;

RayDisplacement CameraRounding::operator()(std::int64_t column, std::int64_t row, const PixelRay& rounded) const {
  const auto [ray, unit] = parts_->meant(column, row);
  const BallRay at_hand{exactly(rounded.ray.origin), normalised(exactly(rounded.ray.direction))};
  const BallSpan span = clipped(ray, parts_->size, parts_->border);
  const BallSpan span_at_hand = clipped(at_hand, parts_->size, parts_->border);
  const Ball shrinking = Ball(rounded.length_unit) / unit;  // what one voxel at hand is of one along the ray meant
  const Ball of_length = span.length() / shrinking - span_at_hand.length();
  RayDisplacement result{.of_length = upper_magnitude(of_length)};
  result.may_differ_in_all = !span.is_known || !span_at_hand.is_known || !std::isfinite(result.of_length);
  if (result.may_differ_in_all || is_zero(span.length()) || is_zero(span_at_hand.length())) return result;
  const BallVector entries = ray.at(span.begin) - at_hand.at(span_at_hand.begin);
  const BallVector turns = ray.direction * shrinking - at_hand.direction;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.at_entry[axis] = upper_magnitude(entries[axis]);
    result.per_voxel[axis] = upper_magnitude(turns[axis]);
  }
  return result;
}

}  // namespace raytruth
