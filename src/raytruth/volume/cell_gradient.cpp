#include "raytruth/volume/cell_gradient.hpp"

#include <algorithm>
#include <cstddef>

namespace raytruth {

namespace {

/// The line from a at 0 to b at 1; equal ends stay as they are.
Vector3<double> between(const Vector3<double>& a, const Vector3<double>& b, double weight) {
  return a + weight * (b - a);
}

}  // namespace

CellGradient::CellGradient(const Grid& grid, const std::array<std::int64_t, 3>& cell) {
  const auto clamped = [&grid](std::int64_t voxel, std::size_t axis) {
    return std::clamp<std::int64_t>(voxel, 0, grid.size[axis] - 1);
  };
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::array<std::int64_t, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = clamped(cell[axis] + static_cast<std::int64_t>(corner >> axis & 1), axis);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto low = at;
      auto high = at;
      low[axis] = clamped(at[axis] - 1, axis);
      high[axis] = clamped(at[axis] + 1, axis);
      corners_[corner][static_cast<Eigen::Index>(axis)] =
          (grid.at(high[0], high[1], high[2]) - grid.at(low[0], low[1], low[2])) / 2 / grid.spacing[axis];
    }
  }
}

Vector3<double> CellGradient::at(const std::array<double, 3>& place) const {
  std::array<Vector3<double>, 4> rows;
  for (std::size_t i = 0; i < 4; ++i) rows[i] = between(corners_[2 * i], corners_[2 * i + 1], place[0]);
  return between(between(rows[0], rows[1], place[1]), between(rows[2], rows[3], place[1]), place[2]);
}

std::array<Bernstein<3>, 3> CellGradient::along(const std::array<double, 3>& p, const std::array<double, 3>& q) const {
  const auto polar = [&](bool x, bool y, bool z) { return at({x ? q[0] : p[0], y ? q[1] : p[1], z ? q[2] : p[2]}); };
  const std::array<Vector3<double>, 4> b{
      polar(false, false, false),
      (polar(true, false, false) + polar(false, true, false) + polar(false, false, true)) / 3,
      (polar(true, true, false) + polar(true, false, true) + polar(false, true, true)) / 3, polar(true, true, true)};
  std::array<Bernstein<3>, 3> result;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 4; ++i) result[axis].coefficients[i] = b[i][static_cast<Eigen::Index>(axis)];
  return result;
}

}  // namespace raytruth
