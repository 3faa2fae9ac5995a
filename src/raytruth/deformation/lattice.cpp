#include "raytruth/deformation/lattice.hpp"

#include "raytruth/core/double_double.hpp"
#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raytruth {

namespace {

/// Turns values at the three control points of one axis into powers of the local coordinate, for all lines along it.
void to_powers(std::array<DoubleDouble, 27>& values, std::size_t stride) {
  for (std::size_t line = 0; line < 27; ++line) {
    if (line / stride % 3 != 0) continue;
    const DoubleDouble first = values[line];
    const DoubleDouble second = values[line + stride];
    const DoubleDouble third = values[line + 2 * stride];
    values[line] = (first + second) * 0.5;
    values[line + stride] = second - first;
    values[line + 2 * stride] = (first - second * 2 + third) * 0.5;
  }
}

}  // namespace

Eigen::Vector3d LatticeCell::value(const Eigen::Vector3d& local) const {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (std::size_t c = 3; c-- > 0;) {
    Eigen::Vector3d plane = Eigen::Vector3d::Zero();
    for (std::size_t b = 3; b-- > 0;) {
      const Eigen::Vector3d line =
          powers[index(0, b, c)] + local[0] * (powers[index(1, b, c)] + local[0] * powers[index(2, b, c)]);
      plane = line + local[1] * plane;
    }
    result = plane + local[2] * result;
  }
  return centre + result;
}

Eigen::Matrix3d LatticeCell::derivative(const Eigen::Vector3d& local) const {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  std::array<std::array<double, 3>, 3> power{};
  std::array<std::array<double, 3>, 3> slope{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = local[static_cast<Eigen::Index>(axis)];
    power[axis] = {1, x, x * x};
    slope[axis] = {0, 1, 2 * x};
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t a = 0; a < 3; ++a) {
        const Eigen::Vector3d& coefficient = powers[index(a, b, c)];
        result.col(0) += slope[0][a] * power[1][b] * power[2][c] * coefficient;
        result.col(1) += power[0][a] * slope[1][b] * power[2][c] * coefficient;
        result.col(2) += power[0][a] * power[1][b] * slope[2][c] * coefficient;
      }
  return result;
}

Lattice::Lattice(const LatticeBox& box, const std::array<std::int64_t, 3>& cells, std::vector<Eigen::Vector3d> points)
    : box_(box), cells_(cells), points_(std::move(points)) {
  std::size_t count = 1;
  for (const std::int64_t axis : cells_) {
    if (axis < 1)
      throw InputError(fmt::format("{} cells on an axis; at least 1, three control points, are allowed", axis));
    count *= static_cast<std::size_t>(axis + 2);
  }
  if (points_.size() != count)
    throw InputError(fmt::format("{} control points; {} of {} x {} x {} are allowed for {} x {} x {} cells",
                                 points_.size(), count, cells_[0] + 2, cells_[1] + 2, cells_[2] + 2, cells_[0],
                                 cells_[1], cells_[2]));
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (!points_[i].allFinite())
      throw InputError(fmt::format("control point {} is [{}, {}, {}]; finite numbers are allowed", i, points_[i][0],
                                   points_[i][1], points_[i][2]));
  const double volume = box_.edges.determinant();
  if (!box_.origin.allFinite() || !box_.edges.allFinite() || !std::isfinite(volume) || volume == 0)
    throw InputError("the box of the lattice has no volume; three edges that do not lie in a plane are allowed");
  inverse_edges_ = box_.edges.inverse();
  for (int axis = 0; axis < 3; ++axis)
    cell_edges_.col(axis) = box_.edges.col(axis) / static_cast<double>(cells_[static_cast<std::size_t>(axis)]);

  cells_of_powers_.reserve(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]));
  for (std::int64_t k = 0; k < cells_[2]; ++k)
    for (std::int64_t j = 0; j < cells_[1]; ++j)
      for (std::int64_t i = 0; i < cells_[0]; ++i) {
        LatticeCell cell;
        cell.centre = point({i + 1, j + 1, k + 1});
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
          std::array<DoubleDouble, 27> values;
          for (std::int64_t c = 0; c < 3; ++c)
            for (std::int64_t b = 0; b < 3; ++b)
              for (std::int64_t a = 0; a < 3; ++a)
                values[static_cast<std::size_t>((c * 3 + b) * 3 + a)] =
                    two_sum(point({i + a, j + b, k + c})[axis], -cell.centre[axis]);
          for (const std::size_t stride : {std::size_t{1}, std::size_t{3}, std::size_t{9}}) to_powers(values, stride);
          for (std::size_t power = 0; power < 27; ++power)
            cell.powers[power][axis] = static_cast<double>(values[power]);
        }
        cells_of_powers_.push_back(cell);
        find_bend();
      }
}

void Lattice::find_bend() {
  // On the whole box: second differences of control points, for every pair of axes, are what second derivatives are
  // means of, in cells.
  const std::array<std::int64_t, 3> size{cells_[0] + 2, cells_[1] + 2, cells_[2] + 2};
  std::array<std::array<double, 3>, 3> largest{};
  const auto unit = [](std::size_t axis) {
    std::array<std::int64_t, 3> step{};
    step[axis] = 1;
    return step;
  };
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b) {
      const auto one = unit(a);
      const auto other = unit(b);
      for (std::int64_t k = 0; k + one[2] + other[2] < size[2]; ++k)
        for (std::int64_t j = 0; j + one[1] + other[1] < size[1]; ++j)
          for (std::int64_t i = 0; i + one[0] + other[0] < size[0]; ++i) {
            const Eigen::Vector3d difference =
                point({i + one[0] + other[0], j + one[1] + other[1], k + one[2] + other[2]}) -
                point({i + one[0], j + one[1], k + one[2]}) - point({i + other[0], j + other[1], k + other[2]}) +
                point({i, j, k});
            largest[a][b] = std::max(largest[a][b], difference.norm());
          }
    }
  double sum = 0;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b) sum += (a == b ? 1 : 2) * largest[a][b] * largest[a][b];
  // By object coordinates: local ones change by no more than the inverse of the cell's edges.
  const double by_object = cell_edges_.inverse().norm();
  bend_ = std::sqrt(sum) * by_object * by_object;
}

Eigen::Vector3d Lattice::operator()(const Eigen::Vector3d& object) const {
  const LatticePlace place = place_of(object);
  return cell(place.cell).value(place.local);
}

Eigen::Matrix3d Lattice::jacobian(const Eigen::Vector3d& object) const {
  const LatticePlace place = place_of(object);
  Eigen::Matrix3d by_local = cell(place.cell).derivative(place.local);
  for (int axis = 0; axis < 3; ++axis)
    by_local.col(axis) *= static_cast<double>(cells_[static_cast<std::size_t>(axis)]);
  return by_local * inverse_edges_;
}

LatticePlace Lattice::place_of(const Eigen::Vector3d& object) const {
  const Eigen::Vector3d parameters = inverse_edges_ * (object - box_.origin);
  LatticePlace place;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scaled = parameters[static_cast<Eigen::Index>(axis)] * static_cast<double>(cells_[axis]);
    const double cell = std::clamp(std::floor(scaled), 0.0, static_cast<double>(cells_[axis] - 1));
    place.cell[axis] = static_cast<std::int64_t>(cell);
    place.local[static_cast<Eigen::Index>(axis)] = scaled - cell;
  }
  return place;
}

Eigen::Vector3d Lattice::object_of(const LatticePlace& place) const {
  Eigen::Vector3d object = box_.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<Eigen::Index>(axis);
    object += (static_cast<double>(place.cell[axis]) + place.local[index]) * cell_edges_.col(index);
  }
  return object;
}

std::vector<Eigen::Vector3d> undisplaced_points(const LatticeBox& box, const std::array<std::int64_t, 3>& cells,
                                                Placement placement) {
  const auto parameter = [&](std::size_t axis, std::int64_t i) {
    const auto count = static_cast<double>(cells[axis]);
    return placement == Placement::greville ? (static_cast<double>(i) - 0.5) / count
                                            : static_cast<double>(i) / (count + 1);
  };
  std::vector<Eigen::Vector3d> points;
  for (std::int64_t k = 0; k < cells[2] + 2; ++k)
    for (std::int64_t j = 0; j < cells[1] + 2; ++j)
      for (std::int64_t i = 0; i < cells[0] + 2; ++i)
        points.emplace_back(box.origin +
                            box.edges * Eigen::Vector3d(parameter(0, i), parameter(1, j), parameter(2, k)));
  return points;
}

}  // namespace raytruth
