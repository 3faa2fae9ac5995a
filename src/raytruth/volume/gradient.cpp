#include "raytruth/volume/gradient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

namespace {

constexpr std::int64_t mean_reach = 2;  // of 5^3 voxels

double clamped_value(const Grid& grid, std::int64_t i, std::int64_t j, std::int64_t k) {
  const auto inside = [&](std::int64_t index, std::size_t axis) {
    return std::clamp<std::int64_t>(index, 0, grid.size[axis] - 1);
  };
  return grid.at(inside(i, 0), inside(j, 1), inside(k, 2));
}

/// Half the difference along an axis of the grid.
double central_difference(const Grid& grid, std::size_t axis, std::int64_t i, std::int64_t j, std::int64_t k) {
  const std::int64_t x = axis == 0 ? 1 : 0;
  const std::int64_t y = axis == 1 ? 1 : 0;
  const std::int64_t z = axis == 2 ? 1 : 0;
  return (clamped_value(grid, i + x, j + y, k + z) - clamped_value(grid, i - x, j - y, k - z)) / 2;
}

Vector3<double> normalized(const Vector3<double>& vector) {
  const double length = vector.matrix().norm();
  return length > 0 ? Vector3<double>(vector / length) : Vector3<double>::Zero();
}

}  // namespace

Vector3<double> voxel_gradient(const Grid& grid, const GradientFilter& filter, std::int64_t i, std::int64_t j,
                               std::int64_t k) {
  Vector3<double> gradient = Vector3<double>::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double& slope = gradient[static_cast<Eigen::Index>(axis)];
    if (std::isinf(filter.weight)) {
      slope = central_difference(grid, axis, i, j, k);
      continue;
    }
    for (std::int64_t first = -1; first <= 1; ++first)
      for (std::int64_t second = -1; second <= 1; ++second) {
        const double weight = (first == 0 ? filter.weight : 1) * (second == 0 ? filter.weight : 1);
        slope += weight * central_difference(grid, axis, i + (axis == 0 ? 0 : first),
                                             j + (axis == 0   ? first
                                                  : axis == 1 ? 0
                                                              : second),
                                             k + (axis == 2 ? 0 : second));
      }
    slope /= (filter.weight + 2) * (filter.weight + 2);
  }
  return gradient;
}

Vector3<double> voxel_normal(const Grid& grid, const GradientFilter& filter, std::int64_t i, std::int64_t j,
                             std::int64_t k) {
  Vector3<double> normal = normalized(voxel_gradient(grid, filter, i, j, k));
  if (filter.exaggeration == 0) return normal;
  Vector3<double> sum = Vector3<double>::Zero();
  double count = 0;
  for (std::int64_t z = k - mean_reach; z <= k + mean_reach; ++z)
    for (std::int64_t y = j - mean_reach; y <= j + mean_reach; ++y)
      for (std::int64_t x = i - mean_reach; x <= i + mean_reach; ++x) {
        const auto inside = [&](std::int64_t index, std::size_t axis) {
          return std::clamp<std::int64_t>(index, 0, grid.size[axis] - 1);
        };
        sum += normalized(voxel_gradient(grid, filter, inside(x, 0), inside(y, 1), inside(z, 2)));
        ++count;
      }
  return normalized(normal + filter.exaggeration * (normal - sum / count));
}

Gradient gradient_at(const Grid& grid, const GradientFilter& filter, const std::array<double, 3>& position) {
  std::array<std::int64_t, 3> voxel{};
  std::array<double, 3> u{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double inside = std::clamp(position[axis], 0.0, static_cast<double>(grid.size[axis] - 1));
    voxel[axis] = std::min(static_cast<std::int64_t>(inside), std::max<std::int64_t>(grid.size[axis] - 2, 0));
    u[axis] = inside - static_cast<double>(voxel[axis]);
  }
  Gradient result;
  for (std::int64_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::int64_t, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t side = corner >> axis & 1;
      weight *= side == 1 ? u[axis] : 1 - u[axis];
      at[axis] = voxel[axis] + side;
    }
    if (weight == 0) continue;
    result.raw += weight * voxel_gradient(grid, filter, at[0], at[1], at[2]);
    result.normal += weight * voxel_normal(grid, filter, at[0], at[1], at[2]);
  }
  result.normal = normalized(result.normal);
  return result;
}

namespace catalogue {

const std::vector<GradientFilter>& gradient_filters() {
  static const std::vector<GradientFilter> list{
      {.name = "central_difference",
       .summary = "half the difference of the two neighbours on an axis",
       .weight = std::numeric_limits<double>::infinity()},
      {.name = "sobel",
       .summary = "central differences averaged with weights 1, 2, 1 over both other axes",
       .weight = 2},
      {.name = "cubic_b_spline",
       .summary = "derivative of the cubic B-spline (not prefiltered): weights 1, 4, 1 over both other axes",
       .weight = 4},
      {.name = "exaggerated",
       .summary = "central differences, each turned away from the mean of the 5^3 around it (epsilon = 1)",
       .weight = std::numeric_limits<double>::infinity(),
       .exaggeration = 1},
  };
  return list;
}

}  // namespace catalogue

}  // namespace raytruth
