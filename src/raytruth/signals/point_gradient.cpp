#include "raytruth/signals/point_gradient.hpp"

#include "raytruth/signals/tricubic_value.hpp"
#include "raytruth/signals/trilinear_value.hpp"
#include "raytruth/volume/cell_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace raytruth {

namespace {

CubicKernel kernel_of(FieldKind field) {
  return field == FieldKind::catmull_rom ? CubicKernel::catmull_rom : CubicKernel::bspline;
}

double value_at(const Grid& grid, FieldKind field, const std::array<double, 3>& position) {
  if (field == FieldKind::trilinear) return trilinear_value(grid, position);
  return tricubic_value(grid, kernel_of(field), position);
}

Vector3<double> differences_at(const Grid& grid, FieldKind field, const std::array<double, 3>& position) {
  Vector3<double> gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto low = position;
    auto high = position;
    low[axis] -= 1;
    high[axis] += 1;
    gradient[static_cast<Eigen::Index>(axis)] =
        (value_at(grid, field, high) - value_at(grid, field, low)) / 2 / grid.spacing[axis];
  }
  return gradient;
}

/// What four voxels of an axis weigh in the value at u in the cell between the middle two, and in its slope.
struct Weights {
  std::array<double, 4> value{};
  std::array<double, 4> slope{};
};

Weights trilinear_weights(double u) { return {{0, 1 - u, u, 0}, {0, -1, 1, 0}}; }

Weights cubic_weights(CubicKernel kernel, double u) {
  const double v = 1 - u;
  const std::array<double, 4> basis{v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
  const std::array<double, 4> slopes{-3 * v * v, 3 * v * (v - 2 * u), 3 * u * (2 * v - u), 3 * u * u};
  Weights weights;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      weights.value[i] += basis[k] * kernel_coefficient<double>(kernel, k, i);
      weights.slope[i] += slopes[k] * kernel_coefficient<double>(kernel, k, i);
    }
  return weights;
}

Vector3<double> analytic_at(const Grid& grid, FieldKind field, const std::array<double, 3>& position) {
  const auto cell = cell_of(grid, position);
  const auto place = in_cell(position, cell);
  std::array<Weights, 3> weights;
  for (std::size_t axis = 0; axis < 3; ++axis)
    weights[axis] =
        field == FieldKind::trilinear ? trilinear_weights(place[axis]) : cubic_weights(kernel_of(field), place[axis]);
  const auto voxel = [&](std::size_t axis, std::size_t i) {
    return std::clamp(cell[axis] - 1 + static_cast<std::int64_t>(i), std::int64_t{0}, grid.size[axis] - 1);
  };
  Vector3<double> gradient = Vector3<double>::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i) {
        const double value = grid.at(voxel(0, i), voxel(1, j), voxel(2, k));
        const auto& [x, y, z] = weights;
        gradient += value * Vector3<double>(x.slope[i] * y.value[j] * z.value[k], x.value[i] * y.slope[j] * z.value[k],
                                            x.value[i] * y.value[j] * z.slope[k]);
      }
  for (std::size_t axis = 0; axis < 3; ++axis) gradient[static_cast<Eigen::Index>(axis)] /= grid.spacing[axis];
  return gradient;
}

}  // namespace

std::array<std::int64_t, 3> cell_of(const Grid& grid, const std::array<double, 3>& position) {
  std::array<std::int64_t, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    cell[axis] =
        std::clamp(static_cast<std::int64_t>(std::floor(position[axis])), std::int64_t{-1}, grid.size[axis] - 1);
  return cell;
}

std::array<double, 3> in_cell(const std::array<double, 3>& position, const std::array<std::int64_t, 3>& cell) {
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] = std::clamp(position[axis] - static_cast<double>(cell[axis]), 0.0, 1.0);
  return result;
}

Vector3<double> PointGradient::operator()(const std::array<double, 3>& position) const {
  switch (kind_) {
    case GradientKind::voxels: {
      const auto cell = cell_of(*voxels_, position);
      return CellGradient(*voxels_, cell).at(in_cell(position, cell));
    }
    case GradientKind::differences:
      return differences_at(*reconstructed_, field_, position);
    case GradientKind::analytic:
      return analytic_at(*reconstructed_, field_, position);
  }
  return Vector3<double>::Zero();
}

}  // namespace raytruth
