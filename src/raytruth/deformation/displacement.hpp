#pragma once

#include "raytruth/deformation/lattice.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace raytruth {

// What moves the control points of a lattice. c is the centre of the lattice's box; along an axis w in [0, 1] is the
// position between both ends of the box and L its length; a and b are the two axes that follow it cyclically. Axes are
// the world's. F is the spline of the moved points, not the formula.

/// Turns planes across the axis by theta = degrees (w - 1/2).
struct Twist {
  std::size_t axis = 2;
  double degrees = 0;
};

/// Bends the z axis towards x, both ends of the box by `degrees` against each other: with k = degrees / L in radians
/// and f = k (z - c_z), x' = c_x + (1 - cos f) / k + (x - c_x) cos f, z' = c_z + sin f / k - (x - c_x) sin f.
struct Bend {
  double degrees = 0;
};

/// Scales a and b about c by scale[0] + (scale[1] - scale[0]) w.
struct Taper {
  std::size_t axis = 2;
  std::array<double, 2> scale{1, 1};
};

/// Scales a and b about c by 1 + amount (1 - (2 w - 1)^2); the spline's own factor is less by amount / n^2 with n cells
/// along the axis.
struct Bulge {
  std::size_t axis = 2;
  double amount = 0;
};

/// c + matrix (p - c) + offset.
struct Affine {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/// Moves every coordinate by amplitude times the size of a cell times a number uniform in [-1, 1), number
/// 3 index + coordinate of the seed's stream.
struct RandomDisplacement {
  double amplitude = 0;
  std::uint64_t seed = 1;
};

using Displacement = std::variant<Twist, Bend, Taper, Bulge, Affine, RandomDisplacement>;

/// Moves the points in the order of the displacements.
void displace(const LatticeBox& box, const std::array<std::int64_t, 3>& cells,
              const std::vector<Displacement>& displacements, std::vector<Eigen::Vector3d>& points);

}  // namespace raytruth
