#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace raytruth {

/// Where the control points of an undisplaced lattice lie along an axis of a cells, at which parameters in [0, 1].
enum class Placement {
  greville,  ///< point i at (i - 1/2) / a: the first and the last half a cell outside, and F is the identity
  printed    ///< point i at i / (a + 1): all inside, and F(u) = (a u + 1/2) / (a + 1) (dissertation, 7.4.3 to 7.4.5)
};

inline constexpr std::array<std::string_view, 2> placement_names{"greville", "printed"};

/// A parallelepiped: origin + u U + v V + w W for u, v, w in [0, 1] (dissertation, equation 7.4.1).
struct LatticeBox {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();  ///< columns U, V, W
};

/// A place in one of the lattice's cells: from 0 to 1 on every axis, or beyond in the outermost ones.
struct LatticePlace {
  std::array<std::int64_t, 3> cell{};
  Eigen::Vector3d local = Eigen::Vector3d::Zero();
};

/// F in one cell, in powers of the local coordinates about one of its control points: centre + sum over a, b, c <= 2 of
/// powers(a, b, c) x^a y^b z^c. Each power is rounded once, so that what is rounded is small as the cell is.
struct LatticeCell {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 27> powers;

  static constexpr std::size_t index(std::size_t a, std::size_t b, std::size_t c) { return (c * 3 + b) * 3 + a; }

  [[nodiscard]] Eigen::Vector3d value(const Eigen::Vector3d& local) const;
  /// Columns: the derivatives by x, y and z.
  [[nodiscard]] Eigen::Matrix3d derivative(const Eigen::Vector3d& local) const;
};

/// A free-form deformation: the map F from object coordinates to world coordinates that a lattice of control points
/// makes, tensor products of uniform quadratic B-splines (T. W. Sederberg, S. R. Parry, Free-form deformation of solid
/// geometric models, 1986; dissertation, 7.3 and 7.4). In a cell of the lattice, with the local coordinate x of an
/// axis,
///
///     F = sum_ijk P_ijk N_i(x) N_j(y) N_k(z),  N = ((1 - x)^2 / 2, 1/2 + x - x^2, x^2 / 2).
///
/// F is once continuously differentiable. Beyond the box it goes on with the polynomial of the nearest cell.
class Lattice {
 public:
  /// `points`: (cells + 2) on every axis, x fastest, as `undisplaced_points` gives them and displacements move them.
  /// Throws InputError for a box without volume, less than one cell, another number of points, and for points and boxes
  /// that are not finite.
  Lattice(const LatticeBox& box, const std::array<std::int64_t, 3>& cells, std::vector<Eigen::Vector3d> points);

  /// The world's point for an object's.
  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& object) const;
  /// DF by object coordinates; its determinant is the volume that a piece of the object comes to.
  [[nodiscard]] Eigen::Matrix3d jacobian(const Eigen::Vector3d& object) const;

  [[nodiscard]] LatticePlace place_of(const Eigen::Vector3d& object) const;
  [[nodiscard]] Eigen::Vector3d object_of(const LatticePlace& place) const;
  /// Object coordinates by the local ones of any cell: columns.
  [[nodiscard]] const Eigen::Matrix3d& cell_edges() const { return cell_edges_; }

  /// A bound of the second derivatives of F by object coordinates: the root of the sum of their squares.
  [[nodiscard]] double bend() const { return bend_; }

  [[nodiscard]] const LatticeBox& box() const { return box_; }
  [[nodiscard]] const std::array<std::int64_t, 3>& cells() const { return cells_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return points_; }
  [[nodiscard]] const LatticeCell& cell(const std::array<std::int64_t, 3>& cell) const {
    return cells_of_powers_[static_cast<std::size_t>((cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0])];
  }
  /// The control point i, j, k, from 0 to cells + 1.
  [[nodiscard]] const Eigen::Vector3d& point(const std::array<std::int64_t, 3>& index) const {
    return points_[static_cast<std::size_t>((index[2] * (cells_[1] + 2) + index[1]) * (cells_[0] + 2) + index[0])];
  }

 private:
  void find_bend();

  LatticeBox box_;
  std::array<std::int64_t, 3> cells_;
  std::vector<Eigen::Vector3d> points_;
  Eigen::Matrix3d inverse_edges_;
  Eigen::Matrix3d cell_edges_;
  std::vector<LatticeCell> cells_of_powers_;
  double bend_ = 0;
};

/// The control points of a lattice that moves nothing, or, `printed`, what the dissertation's placement moves.
std::vector<Eigen::Vector3d> undisplaced_points(const LatticeBox& box, const std::array<std::int64_t, 3>& cells,
                                                Placement placement);

}  // namespace raytruth
