#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/signals/trilinear_value.hpp"
#include "raytruth/volume/grid.hpp"

#include <algorithm>
#include <vector>

namespace raytruth::testing_support {

/// The ray's points in 50 digits; t = 0 where it enters the volume.
struct ExactRay {
  std::array<Real50, 3> start;
  std::array<Real50, 3> direction;
  Real50 length;  ///< negative: the ray misses the field

  [[nodiscard]] std::array<Real50, 3> point(const Real50& t) const {
    return {start[0] + t * direction[0], start[1] + t * direction[1], start[2] + t * direction[2]};
  }
};

/// The ray by clipping against the six faces, with `unit` for the ray's direction.
inline ExactRay exact_ray(const Grid& grid, const Ray& ray, const std::array<Real50, 3>& unit,
                          Border border = Border::half_voxel) {
  Real50 begin = 0;
  Real50 end("1e100");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real50 beyond(border == Border::half_voxel ? "0.5" : "0");
    const Real50 low = -beyond;
    const Real50 high = Real50(grid.size[axis] - 1) + beyond;
    const Real50 origin(ray.origin[axis]);
    if (unit[axis] == 0) {
      if (origin < low || origin > high) end = -1;
      continue;
    }
    const Real50 a = (low - origin) / unit[axis];
    const Real50 b = (high - origin) / unit[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  ExactRay result{{}, {}, end - begin};
  if (result.length > ray.length) result.length = ray.length;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.direction[axis] = unit[axis];
    result.start[axis] = Real50(ray.origin[axis]) + begin * unit[axis];
  }
  return result;
}

/// The ray at the rounded unit direction.
inline ExactRay exact_ray(const Grid& grid, const Ray& ray, Border border = Border::half_voxel) {
  const auto unit = unit_direction(ray.direction);
  return exact_ray(grid, ray, {unit[0], unit[1], unit[2]}, border);
}

/// The ray at the exactly normalised direction.
inline ExactRay exactly_directed_ray(const Grid& grid, const Ray& ray, Border border = Border::half_voxel) {
  std::array<Real50, 3> unit{ray.direction[0], ray.direction[1], ray.direction[2]};
  const Real50 norm = sqrt(unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2]);
  for (Real50& component : unit) component /= norm;
  return exact_ray(grid, ray, unit, border);
}

/// The chain of cubics of a trilinear ray without any walk: all crossings of all borders, sorted; in each interval the
/// cubic through the values at four points.
inline Chain<3, Real50> exact_chain(const Grid& grid, const Ray& ray, Border border = Border::half_voxel) {
  const ExactRay exact = exact_ray(grid, ray, border);
  Chain<3, Real50> chain;
  if (!(exact.length > 0)) return chain;
  std::vector<Real50> breaks{0, exact.length};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (exact.direction[axis] == 0) continue;
    for (std::int64_t border = 0; border < grid.size[axis]; ++border) {
      const Real50 t = (Real50(border) - exact.start[axis]) / exact.direction[axis];
      if (t > 0 && t < exact.length) breaks.push_back(t);
    }
  }
  std::sort(breaks.begin(), breaks.end());
  const Real50 tie = ldexp(exact.length, -110);  // far below any distance of crossings that are not one
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const Real50 begin = breaks[i];
    const Real50 length = breaks[i + 1] - begin;
    if (length < tie) continue;
    const auto value = [&](const char* u) { return trilinear_value(grid, exact.point(begin + Real50(u) * length)); };
    // Inside the cell at 1/5 ... 4/5: a point on the border itself may round to either side, which is as good.
    const std::array<Real50, 4> v{value("0.2"), value("0.4"), value("0.6"), value("0.8")};
    const auto at = [&](const Real50& x) {  // Lagrange, x in fifths
      Real50 sum = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        Real50 basis = 1;
        for (std::size_t m = 0; m < 4; ++m)
          if (m != k) basis *= (x - Real50(m + 1)) / (Real50(k + 1) - Real50(m + 1));
        sum += basis * v[k];
      }
      return sum;
    };
    // Bernstein coefficients from the values at 0, 1/3, 2/3 and 1.
    const Real50 f0 = at(0);
    const Real50 f1 = at(Real50(5) / 3);
    const Real50 f2 = at(Real50(10) / 3);
    const Real50 f3 = at(5);
    chain.pieces.push_back(
        {begin,
         length,
         {{f0, (-5 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 6, (2 * f0 - 9 * f1 + 18 * f2 - 5 * f3) / 6, f3}}});
  }
  chain.end = exact.length;
  return chain;
}

inline Real50 in_50_digits(const DoubleDouble& t) { return Real50(t.high) + Real50(t.low); }

}  // namespace raytruth::testing_support
