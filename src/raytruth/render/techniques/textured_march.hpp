#pragma once

#include "raytruth/render/camera.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/textures/texture_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace raytruth {

/// A pixel as a renderer on a GPU makes it: the volume and the transfer function (colour and extinction at equally
/// spaced scalars from 0 to 1) are textures, read through units of any precision at the midpoints of steps; associated
/// colours, composited from front to back. Positions are computed in binary64; coordinates are rounded to Real, in
/// which everything behind them is computed. The volume ends half a voxel beyond its outermost centres. `step` is in
/// smallest spacings; light in the first three numbers, opacity in the fourth.
template <class Real>
typename Rules<Real>::vec4 march_textures(const TextureUnit<Real>& volume, const TextureUnit<Real>& transfer,
                                          const PixelRay& pixel, double step) {
  using vec4 = typename Rules<Real>::vec4;
  Rules<Real> rules;
  vec4 sum = vec4::Constant(Real(0));
  const auto& size = volume.texture().size;
  const auto direction = unit_direction(pixel.ray.direction);
  const Span span = clip(size, Border::half_voxel, pixel.ray.origin, direction);
  if (!(span.begin < span.end)) return sum;

  const auto entries = static_cast<double>(transfer.texture().size[0]);
  const auto begin = static_cast<double>(span.begin);
  const double length = static_cast<double>(span.end - span.begin) * pixel.length_unit;
  const auto count = static_cast<std::int64_t>(std::ceil(length / step));
  for (std::int64_t i = 0; i < count; ++i) {
    const double front = static_cast<double>(i) * step;
    const double width = std::min(step, length - front);
    const double t = begin + (front + width / 2) / pixel.length_unit;
    std::array<Real, 3> coordinate{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      coordinate[axis] = (pixel.ray.origin[axis] + t * direction[axis] + 0.5) / static_cast<double>(size[axis]);
    const Real scalar = volume.linear(coordinate)[0];
    vec4 optics = transfer.linear({(scalar * Real(entries - 1) + Real(0.5)) / Real(entries)});
    const Real extinction = optics[3];
    optics = extinction * optics;
    optics[3] = extinction;
    sum = rules.over(sum, rules.homogeneous_slab(optics, Real(width), false));
  }
  return sum;
}

}  // namespace raytruth
